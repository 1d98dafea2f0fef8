#pragma once

#include <optional>

#include "maps/stamp.hpp"

namespace lodestar {

/// The control lease: one client at a time may drive, and only while it keeps renewing it.
class Lease {
 public:
  explicit Lease(Duration lasts) : lasts_(lasts) {}

  /// False while another client has it.
  bool take(int client, Stamp now) {
    if (holder(now).value_or(client) != client) return false;
    holder_ = client;
    until_ = now + lasts_;
    return true;
  }

  /// Renews it. False, and nothing changes, for a client that does not have it (any more).
  bool hold(int client, Stamp now) { return holder(now) == client && take(client, now); }

  /// Hands it over to another client without a pause. False, and nothing changes, where `from` does not have
  /// it.
  bool pass(int from, int to, Stamp now) {
    if (holder(now) != from) return false;
    holder_ = to;
    until_ = now + lasts_;
    return true;
  }

  /// Gives it back, if the client has it.
  void release(int client) {
    if (holder_ == client) holder_.reset();
  }

  [[nodiscard]] std::optional<int> holder(Stamp now) const { return now < until_ ? holder_ : std::nullopt; }
  /// When it expires; in the past while no client has it.
  [[nodiscard]] Stamp until() const { return holder_ ? until_ : Stamp{}; }

 private:
  Duration lasts_;
  std::optional<int> holder_;
  Stamp until_;
};

}  // namespace lodestar
