#pragma once

#include <optional>

#include "maps/stamp.hpp"

namespace lodestar {

/// Who is at the wheel: one client at a time, and only as long as it says so again and again.
class Lease {
 public:
  explicit Lease(Duration lasts) : lasts_(lasts) {}

  /// False while somebody else has it.
  bool take(int client, Stamp now) {
    if (holder(now).value_or(client) != client) return false;
    holder_ = client;
    until_ = now + lasts_;
    return true;
  }

  /// False, and nothing changes, for a client that does not have it (any more).
  bool hold(int client, Stamp now) { return holder(now) == client && take(client, now); }

  /// Gives it back, if the client has it.
  void release(int client) {
    if (holder_ == client) holder_.reset();
  }

  [[nodiscard]] std::optional<int> holder(Stamp now) const { return now < until_ ? holder_ : std::nullopt; }
  /// When it runs out; the past while nobody has it.
  [[nodiscard]] Stamp until() const { return holder_ ? until_ : Stamp{}; }

 private:
  Duration lasts_;
  std::optional<int> holder_;
  Stamp until_;
};

}  // namespace lodestar
