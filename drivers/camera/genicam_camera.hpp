#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>

#include "drivers/camera/device_camera.hpp"
#include "drivers/system/device_clock.hpp"

// Aravis's own names, so that its headers stay out of here.
struct _ArvBuffer;  // NOLINT(bugprone-reserved-identifier)
struct _ArvCamera;  // NOLINT(bugprone-reserved-identifier)
struct _ArvStream;  // NOLINT(bugprone-reserved-identifier)

namespace lodestar {

struct GenicamCameraOptions {
  int width_px = 0;   ///< 0: whatever the camera is set to
  int height_px = 0;  ///< the same
  /// Frames that wait until they are polled; when there are more the camera's new ones are dropped.
  int buffers = 4;
  // Set at every opening; empty: as the camera is set.
  std::optional<Duration> exposure;
  std::optional<double> gain;  ///< in the camera's unit, mostly decibels
  std::optional<double> rate_hz;
  /// From the end of exposure to the arrival of a frame that nothing delays: readout and transfer.
  Duration latency{};
};

/// A machine-vision camera (GigE Vision, USB3 Vision) by its GenICam description, with 8-bit gray pixels.
/// Stamps are its own clock's, which ticks without jitter, put on the robot's by the quickest arrivals, and
/// moved to mid-exposure. By Aravis.
class GenicamCamera final : public DeviceCamera {
 public:
  /// Starts streaming. `id`: the camera's name as `arv-tool-0.8` lists it ("Vendor-serial number"), its
  /// address, or "any" for the only one there is. Throws InputError when there is none, and when it does not
  /// deliver the requested size, gray pixels, or does not take a setting.
  GenicamCamera(const std::string& id, const GenicamCameraOptions& options);
  ~GenicamCamera() override;

  /// Frames that have lost packets are skipped.
  std::optional<Frame> poll() override;

  [[nodiscard]] std::string description() const override;
  [[nodiscard]] bool lost() const override { return lost_; }

 private:
  struct Unref {
    void operator()(void* object) const;
  };

  void apply_settings();
  void choose_region();
  void start();
  [[nodiscard]] Stamp middle_of_exposure(_ArvBuffer* buffer);
  [[noreturn]] void refuse(const std::string& found, const std::string& wanted) const;

  std::string name_;
  GenicamCameraOptions options_;
  std::unique_ptr<_ArvCamera, Unref> camera_;
  std::unique_ptr<_ArvStream, Unref> stream_;
  std::string words_;  ///< vendor and model
  Duration exposure_{};
  std::optional<double> rate_hz_;
  DeviceClock clock_{{.tick = std::chrono::nanoseconds(1), .max_drift = 1e-3}};  // a crystal's, and room
  std::atomic<bool> lost_ = false;
};

}  // namespace lodestar
