#include "drivers/camera/video_device.hpp"

#include <cerrno>
#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <system_error>
#include <unistd.h>
#include <utility>
#include <vector>

#include "maps/input_error.hpp"

namespace lodestar {
namespace {

class DeviceNode final : public VideoDevice {
 public:
  explicit DeviceNode(int descriptor) : descriptor_(descriptor) {}

  ~DeviceNode() override {
    for (const auto& [memory, length] : mapped_) ::munmap(memory, length);
    ::close(descriptor_);
  }

  int control(unsigned long request, void* argument) override {
    while (::ioctl(descriptor_, request, argument) != 0) {
      if (errno != EINTR) return errno;
    }
    return 0;
  }

  std::span<const std::uint8_t> map(std::size_t length, std::int64_t offset) override {
    void* memory = ::mmap(nullptr, length, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor_, offset);
    if (memory == MAP_FAILED) return {};
    mapped_.emplace_back(memory, length);
    return {static_cast<const std::uint8_t*>(memory), length};
  }

  void wait(Duration at_most) override {
    pollfd waiting{.fd = descriptor_, .events = POLLIN, .revents = 0};
    const auto ms = std::chrono::ceil<std::chrono::milliseconds>(at_most);
    (void)::poll(&waiting, 1, static_cast<int>(ms.count()));
  }

  [[nodiscard]] Stamp now() const override {
    return Stamp(std::chrono::steady_clock::now().time_since_epoch());
  }

 private:
  int descriptor_;
  std::vector<std::pair<void*, std::size_t>> mapped_;
};

}  // namespace

std::unique_ptr<VideoDevice> open_video_device(const std::filesystem::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) {
    throw InputError(file, 0,
                     "a device that cannot be opened (" + std::generic_category().message(errno) + ")",
                     "a camera that this user may read and write");
  }
  return std::make_unique<DeviceNode>(descriptor);
}

}  // namespace lodestar
