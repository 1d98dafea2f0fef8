#include "app/drive/operator_input.hpp"

#include <array>
#include <poll.h>
#include <unistd.h>

namespace lodestar {

std::optional<OperatorWord> OperatorInput::poll() {
  read_more();
  while (true) {
    const std::size_t end = text_.find('\n');
    if (end == std::string::npos) return std::nullopt;
    const std::string line = text_.substr(0, end);
    text_.erase(0, end + 1);
    if (line == "resume") return OperatorWord::resume;
    if (line == "stop") return OperatorWord::stop;
  }
}

void OperatorInput::read_more() {
  pollfd input{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
  if (ended_ || ::poll(&input, 1, 0) <= 0) return;
  std::array<char, 256> bytes{};
  const ssize_t size = ::read(STDIN_FILENO, bytes.data(), bytes.size());
  if (size <= 0) {
    ended_ = true;
  } else {
    text_.append(bytes.data(), static_cast<std::size_t>(size));
  }
}

}  // namespace lodestar
