#include "drivers/camera/genicam_camera.hpp"

#include <arv.h>
#include <cmath>
#include <fmt/format.h>
#include <opencv2/core.hpp>

#include "drivers/system/clock.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

/// What a call of Aravis says if it fails.
class Complaint {
 public:
  Complaint() = default;
  Complaint(const Complaint&) = delete;
  Complaint& operator=(const Complaint&) = delete;
  ~Complaint() { g_clear_error(&error_); }

  operator GError**() { return &error_; }  // as the calls take it
  [[nodiscard]] bool is_there() const { return error_ != nullptr; }
  [[nodiscard]] std::string words() const { return error_ == nullptr ? "" : error_->message; }

 private:
  GError* error_ = nullptr;
};

double microseconds(Duration duration) {
  return std::chrono::duration<double, std::micro>(duration).count();
}

}  // namespace

void GenicamCamera::Unref::operator()(void* object) const {
  g_object_unref(object);
}

GenicamCamera::GenicamCamera(const std::string& id, const GenicamCameraOptions& options)
    : name_("genicam:" + id), options_(options) {
  Complaint complaint;
  camera_.reset(arv_camera_new(id == "any" ? nullptr : id.c_str(), complaint));
  if (!camera_) refuse("no such camera: " + complaint.words(), "one that arv-tool-0.8 lists");
  arv_device_set_range_check_policy(arv_camera_get_device(camera_.get()), ARV_RANGE_CHECK_POLICY_ENABLE);
  choose_region();
  apply_settings();
  start();
}

GenicamCamera::~GenicamCamera() {
  if (camera_) {
    g_signal_handlers_disconnect_by_data(arv_camera_get_device(camera_.get()), &lost_);
    if (!lost_) arv_camera_stop_acquisition(camera_.get(), Complaint());
  }
  stream_.reset();  // before the camera that it belongs to
}

void GenicamCamera::refuse(const std::string& found, const std::string& wanted) const {
  throw InputError(name_, 0, found, wanted);
}

void GenicamCamera::choose_region() {
  Complaint complaint;
  arv_camera_set_pixel_format(camera_.get(), ARV_PIXEL_FORMAT_MONO_8, complaint);
  if (complaint.is_there()) refuse("no gray pixels of 8 bits: " + complaint.words(), "pixel format Mono8");
  if (options_.width_px == 0) return;
  arv_camera_set_region(camera_.get(), 0, 0, options_.width_px, options_.height_px, Complaint());
  gint width = 0;
  gint height = 0;
  arv_camera_get_region(camera_.get(), nullptr, nullptr, &width, &height, complaint);
  if (width != options_.width_px || height != options_.height_px)
    refuse(fmt::format("{} x {} pixels", width, height),
           fmt::format("{} x {}, as its calibration", options_.width_px, options_.height_px));
}

void GenicamCamera::apply_settings() {
  ArvCamera* camera = camera_.get();
  Complaint exposure;
  if (options_.exposure) {
    arv_camera_set_exposure_time_auto(camera, ARV_AUTO_OFF, Complaint());  // not every camera has it
    arv_camera_set_exposure_time(camera, microseconds(*options_.exposure), exposure);
  }
  if (exposure.is_there()) refuse("no exposure that can be set: " + exposure.words(), "one that can");
  Complaint gain;
  if (options_.gain) {
    arv_camera_set_gain_auto(camera, ARV_AUTO_OFF, Complaint());
    arv_camera_set_gain(camera, *options_.gain, gain);
  }
  if (gain.is_there()) refuse("no gain that can be set: " + gain.words(), "one that can");
  Complaint rate;
  if (options_.rate_hz) arv_camera_set_frame_rate(camera, *options_.rate_hz, rate);
  if (rate.is_there()) refuse("no frame rate that can be set: " + rate.words(), "one that can");

  Complaint unknown;
  const double exposure_us = arv_camera_get_exposure_time(camera, unknown);
  if (!unknown.is_there()) exposure_ = from_seconds(1e-6 * exposure_us);
  Complaint no_rate;
  const double rate_hz = arv_camera_get_frame_rate(camera, no_rate);
  if (!no_rate.is_there()) rate_hz_ = rate_hz;
  const auto text = [](const char* word) { return std::string(word == nullptr ? "" : word); };
  words_ = text(arv_camera_get_vendor_name(camera, Complaint())) + " " +
           text(arv_camera_get_model_name(camera, Complaint()));
}

void GenicamCamera::start() {
  ArvCamera* camera = camera_.get();
  Complaint complaint;
  arv_camera_set_acquisition_mode(camera, ARV_ACQUISITION_MODE_CONTINUOUS, Complaint());
  const guint bytes = arv_camera_get_payload(camera, complaint);
  if (!complaint.is_there()) stream_.reset(arv_camera_create_stream(camera, nullptr, nullptr, complaint));
  if (!stream_) refuse("a camera that does not stream: " + complaint.words(), "a stream");
  for (int i = 0; i < options_.buffers; ++i)
    arv_stream_push_buffer(stream_.get(), arv_buffer_new(bytes, nullptr));
  arv_camera_start_acquisition(camera, complaint);
  if (complaint.is_there()) refuse("a camera that does not start: " + complaint.words(), "a stream");
  // From a thread of Aravis, when heartbeats are not answered or the cable is out. Last: the destructor,
  // which ends it, is not for a constructor that has thrown.
  const auto note_loss = +[](ArvDevice*, std::atomic<bool>* lost) { *lost = true; };
  g_signal_connect(arv_camera_get_device(camera), "control-lost", G_CALLBACK(note_loss), &lost_);
}

/// The camera stamps the start of exposure by its own clock, whose origin is learned from arrivals: what
/// comes out is when the frame would have arrived if nothing had delayed it.
Stamp GenicamCamera::middle_of_exposure(_ArvBuffer* buffer) {
  const auto since_epoch = std::chrono::nanoseconds(arv_buffer_get_system_timestamp(buffer));
  const Stamp arrival = Stamp(since_epoch - system_clock_offset());
  const std::uint64_t ticks_ns = arv_buffer_get_timestamp(buffer);
  const Stamp undelayed = ticks_ns == 0 ? arrival : clock_.stamp_of(ticks_ns, arrival);
  return undelayed - options_.latency - exposure_ / 2;
}

std::optional<Frame> GenicamCamera::poll() {
  while (ArvBuffer* buffer = arv_stream_try_pop_buffer(stream_.get())) {
    std::optional<Frame> frame;
    std::size_t bytes = 0;
    if (arv_buffer_get_status(buffer) == ARV_BUFFER_STATUS_SUCCESS) {
      const auto* pixels = static_cast<const std::uint8_t*>(arv_buffer_get_data(buffer, &bytes));
      const int width = arv_buffer_get_image_width(buffer);
      const int height = arv_buffer_get_image_height(buffer);
      if (bytes >= static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {
        frame = Frame{.stamp = middle_of_exposure(buffer), .gray = cv::Mat(height, width, CV_8UC1)};
        std::copy_n(pixels, frame->gray.total(), frame->gray.data);
      }
    }
    arv_stream_push_buffer(stream_.get(), buffer);
    if (frame) return frame;
  }
  return std::nullopt;
}

std::string GenicamCamera::description() const {
  std::string words = words_;
  if (rate_hz_) words += fmt::format(", {:.4g} frames a second", *rate_hz_);
  words += exposure_ > Duration{} ? fmt::format(", exposure {:.1f} ms", 1e-3 * microseconds(exposure_))
                                  : ", exposure not reported";
  return words + ", stamped by its own clock";
}

}  // namespace lodestar
