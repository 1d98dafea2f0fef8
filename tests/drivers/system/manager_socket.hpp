#pragma once

#include <array>
#include <cstring>
#include <stdexcept>
#include <string>
#include <sys/socket.h>
#include <sys/un.h>
#include <vector>

#include "drivers/system/file_descriptor.hpp"

#include "tests/maps/temporary_folder.hpp"

namespace lodestar {

/// A service manager's end of the socket of sd_notify(3).
class ManagerSocket {
 public:
  ManagerSocket() : receiver_(::socket(AF_UNIX, SOCK_DGRAM, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(static_cast<char*>(address.sun_path), path().c_str(), sizeof(address.sun_path) - 1);
    if (::bind(receiver_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0)
      throw std::runtime_error("cannot bind the manager's socket");
  }

  [[nodiscard]] std::string path() const { return (folder_.path() / "notify").string(); }

  /// All that was said and not yet heard.
  [[nodiscard]] std::vector<std::string> hear() const {
    std::vector<std::string> heard;
    std::array<char, 256> text{};
    for (ssize_t size = 0; (size = ::recv(receiver_.get(), text.data(), text.size(), MSG_DONTWAIT)) >= 0;)
      heard.emplace_back(text.data(), static_cast<std::size_t>(size));
    return heard;
  }

 private:
  TemporaryFolder folder_;
  FileDescriptor receiver_;
};

}  // namespace lodestar
