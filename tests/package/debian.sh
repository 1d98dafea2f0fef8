# For scripts that try packages in a Debian 12 made for it; to be sourced.

# new_debian ROOT LOG PACKAGES: a minimal Debian 12 with these packages (commas between them) and this machine's apt
# configuration. Exits with 77 where it cannot be fetched.
new_debian() {
  local root=$1 log=$2 packages=$3 mirror
  mirror=$({ cat /etc/apt/sources.list.d/debian.sources /etc/apt/sources.list 2>/dev/null || true; } |
    sed -nE 's/^(URIs: |deb (\[[^]]*\] )?)(http[^ ]*).*/\3/p' | head -1)
  debootstrap --variant=minbase ${packages:+--include="$packages"} bookworm "$root" \
    "${mirror:-http://deb.debian.org/debian}" >"$log" 2>&1 ||
    { tail -5 "$log"; echo "${0##*/}: skipped: debootstrap cannot fetch Debian 12"; exit 77; }
  rm -rf "$root/etc/apt"
  cp -a /etc/apt "$root/etc/apt"
  cp -L /etc/resolv.conf "$root/etc/resolv.conf" 2>/dev/null || true
}

# Runs the script once more in a mount namespace of its own, with which what it mounts ends. Exits with 77 without root,
# debootstrap or namespaces.
in_own_namespace() {
  if ((EUID != 0)) || ! command -v debootstrap >/dev/null; then
    echo "${0##*/}: skipped: wanted root and debootstrap"
    exit 77
  fi
  [[ -z ${LODESTAR_IN_NAMESPACE:-} ]] || return 0
  unshare --mount true 2>/dev/null || { echo "${0##*/}: skipped: no mount namespaces here"; exit 77; }
  LODESTAR_IN_NAMESPACE=1 exec unshare --mount "$0" "$@"
}

# A command in $root, with nothing of this environment.
in_root() {
  chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8 "$@"
}
