#include "app/common/interruption.hpp"

#include <csignal>

namespace lodestar {
namespace {

volatile std::sig_atomic_t was_asked = 0;  // a signal's handler reaches nothing else

void handle(int /*signal*/) {
  was_asked = 1;
}

/// SA_RESETHAND: the second signal does what it does by default. No SA_RESTART: waiting calls return.
void install(void (*handler)(int)) {
  struct sigaction action{};
  action.sa_handler = handler;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

}  // namespace

Interruption::Interruption() {
  was_asked = 0;
  install(handle);
}

Interruption::~Interruption() {
  install(SIG_DFL);
}

bool Interruption::asked() {
  return was_asked != 0;
}

}  // namespace lodestar
