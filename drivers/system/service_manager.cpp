#include "drivers/system/service_manager.hpp"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace lodestar {
namespace {

/// Empty when it is not set.
std::string_view variable(const char* name) {
  const char* const text = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): nobody changes it
  return text == nullptr ? std::string_view() : text;
}

std::optional<std::int64_t> whole_number(std::string_view text) {
  std::int64_t number = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || rest != text.data() + text.size()) return std::nullopt;
  return number;
}

std::optional<Duration> watchdog_of_this_process() {
  if (const std::string_view process = variable("WATCHDOG_PID"); !process.empty()) {
    if (whole_number(process) != std::int64_t{::getpid()}) return std::nullopt;
  }
  const std::optional<std::int64_t> microseconds = whole_number(variable("WATCHDOG_USEC"));
  if (!microseconds || *microseconds <= 0) return std::nullopt;
  return std::chrono::microseconds(*microseconds);
}

struct Address {
  sockaddr_un name{};
  socklen_t size = 0;
};

/// Nothing when the text is none.
std::optional<Address> address_from(const std::string& text) {
  Address address;
  const bool is_address = text.starts_with('/') || text.starts_with('@');
  if (!is_address || text.size() < 2 || text.size() >= sizeof(address.name.sun_path)) return std::nullopt;
  address.name.sun_family = AF_UNIX;
  std::memcpy(static_cast<char*>(address.name.sun_path), text.data(), text.size());
  if (text.front() == '@') address.name.sun_path[0] = '\0';
  // An abstract name has no end but the address's; a path ends with a zero, which need not be counted.
  address.size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + text.size());
  return address;
}

}  // namespace

ServiceEnvironment service_environment() {
  return {.socket = std::string(variable("NOTIFY_SOCKET")), .watchdog = watchdog_of_this_process()};
}

ServiceManager::ServiceManager(const ServiceEnvironment& environment) : address_(environment.socket) {
  if (address_from(address_)) socket_ = FileDescriptor(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  constexpr int signs = 4;  // the manual recommends two
  if (environment.watchdog) watchdog_period_ = *environment.watchdog / signs;
}

void ServiceManager::step(Stamp now) {
  if (!socket_.is_open()) return;
  if (!is_ready_) {
    is_ready_ = send("READY=1\nWATCHDOG=1");
    last_sign_ = now;
    return;
  }
  if (!watchdog_period_ || now - last_sign_ < *watchdog_period_) return;
  if (send("WATCHDOG=1")) last_sign_ = now;
}

void ServiceManager::tell_status(std::string_view words) const {
  std::string state = "STATUS=" + std::string(words);
  std::ranges::replace(state, '\n', ' ');
  (void)send(state);
}

void ServiceManager::stop() {
  (void)send("STOPPING=1");
}

/// The address is looked up each time: a manager that was started anew has another socket of that name.
bool ServiceManager::send(const std::string& state) const {
  const std::optional<Address> address = address_from(address_);
  if (!socket_.is_open() || !address) return false;
  return ::sendto(socket_.get(), state.data(), state.size(), MSG_DONTWAIT | MSG_NOSIGNAL,
                  reinterpret_cast<const sockaddr*>(&address->name),
                  address->size) == static_cast<ssize_t>(state.size());
}

}  // namespace lodestar
