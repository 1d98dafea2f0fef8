#include "app/common/interruption.hpp"

#include <csignal>

namespace lodestar {
namespace {

volatile std::sig_atomic_t was_asked = 0;  // a signal's handler reaches nothing else
int living = 0;
struct sigaction before_int;
struct sigaction before_term;

void handle(int /*signal*/) {
  was_asked = 1;
}

/// SA_RESETHAND: the second signal does what it does by default. No SA_RESTART: waiting calls return.
struct sigaction asking() {
  struct sigaction action{};
  action.sa_handler = handle;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigemptyset(&action.sa_mask);
  return action;
}

}  // namespace

Interruption::Interruption() {
  if (++living > 1) return;
  was_asked = 0;
  const struct sigaction action = asking();
  sigaction(SIGINT, &action, &before_int);
  sigaction(SIGTERM, &action, &before_term);
}

Interruption::~Interruption() {
  if (--living > 0) return;
  sigaction(SIGINT, &before_int, nullptr);
  sigaction(SIGTERM, &before_term, nullptr);
}

bool Interruption::asked() {
  return was_asked != 0;
}

}  // namespace lodestar
