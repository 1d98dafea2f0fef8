#include "app/bench/counts.hpp"

#include <algorithm>

#include "app/bench/truth.hpp"
#include "app/common/parallel.hpp"

namespace lodestar {
namespace {

constexpr int frames_per_scene = 25;

/// Is the whole marker, all 16 cells, inside the image and not occluded?
bool is_in_full_view(const TrueMarker& marker, double pitch_px, const BenchView& view,
                     const CameraModel& camera) {
  const double reach_px = 2.5 * pitch_px;
  if (!camera.contains(marker.center_px, reach_px)) return false;
  return std::ranges::none_of(view.covers, [&](const PrintedSquare& cover) {
    const auto center =
        camera.project(view.map_from_camera.inverse() * Vec3(cover.map_from_square.translation()));
    const double cover_px = cover.side_m * pitch_px / marker_pitch_m * std::numbers::sqrt2 / 2.0;
    return center && (*center - marker.center_px).norm() < reach_px + cover_px;
  });
}

void add(const FrameCounts& part, FrameCounts& whole) {
  whole.frames += part.frames;
  whole.markers += part.markers;
  whole.read += part.read;
  whole.right += part.right;
  whole.wrong += part.wrong;
  whole.frames_with_wrong += part.frames_with_wrong;
  whole.stated.insert(whole.stated.end(), part.stated.begin(), part.stated.end());
}

/// The scene's ceiling, with the method's markers where they hang.
ImageFormer former_of(const HardScene& scene, const CameraModel& camera, std::uint64_t seed,
                      BenchMethod& method) {
  const auto lit_by_sun = [&](const MarkerRegistry& registry) {
    ImageFormer former(registry, camera, scene.light, seed);
    for (const PrintedSquare& patch : scene.sun) former.add(patch);
    return former;
  };
  ImageFormer former = lit_by_sun(scene.registry);
  method.install(scene.registry, camera, former);
  return scene.markers_hang ? std::move(former) : lit_by_sun({});
}

/// The frames of one scene.
FrameCounts count_scene(const SceneSource& source, BenchMethod& method, int frames, Random random) {
  const HardScene scene = source.scene(random);
  const CameraModel camera = bench_camera();
  ImageFormer former = former_of(scene, camera, random.bits(), method);
  const double pitch_px = camera.fx_px * marker_pitch_m / scene.ceiling_m;

  FrameCounts counts;
  for (int i = 0; i < frames; ++i) {
    const BenchView view = source.view(scene, random);
    former.cover(view.covers);
    const cv::Mat gray =
        former.expose(view.map_from_camera, view.map_from_camera, static_cast<std::uint64_t>(i));
    const std::vector<ReadMarker> readings = method.read(gray);
    const std::vector<TrueMarker> truth =
        scene.markers_hang ? markers_in_view(method, scene.registry, view.map_from_camera, camera)
                           : std::vector<TrueMarker>{};
    const ReadingCount count = judged(readings, truth);
    ++counts.frames;
    counts.right += count.right;
    counts.wrong += count.wrong;
    counts.frames_with_wrong += count.wrong > 0 ? 1 : 0;
    for (const TrueMarker& marker : truth) {
      if (!is_in_full_view(marker, pitch_px, view, camera)) continue;
      ++counts.markers;
      counts.read += is_read(marker, readings) ? 1 : 0;
    }
    for (const ReadMarker& reading : readings)
      if (reading.probability) counts.stated.push_back({*reading.probability, is_right(reading, truth)});
  }
  return counts;
}

}  // namespace

FrameCounts count_frames(const SceneSource& source, const MethodChoice& choice, int frames,
                         const Random& random, const std::function<void(int frames)>& done) {
  const int scenes = (frames + frames_per_scene - 1) / frames_per_scene;
  std::vector<FrameCounts> parts(static_cast<std::size_t>(scenes));
  in_parallel(scenes, [&](int i) {
    const std::unique_ptr<BenchMethod> method = choice.make();
    const int count = std::min(frames_per_scene, frames - i * frames_per_scene);
    const Random of_scene = random.stream(static_cast<std::uint64_t>(i));
    parts[static_cast<std::size_t>(i)] = count_scene(source, *method, count, of_scene);
    done(count);
  });
  FrameCounts counts;
  for (const FrameCounts& part : parts) add(part, counts);
  return counts;
}

FrameCounts count_frames(HardFrames kind, const MethodChoice& choice, int frames, std::uint64_t seed,
                         const std::function<void(int frames)>& done) {
  const SceneSource source{
      .scene = [kind](Random& random) { return some_hard_scene(kind, random); },
      .view = [kind](const HardScene& scene, Random& random) { return some_hard_view(kind, scene, random); }};
  return count_frames(source, choice, frames, Random(seed).stream(static_cast<std::uint64_t>(kind)), done);
}

}  // namespace lodestar
