#include "app/bench/ceilings.hpp"

namespace lodestar {
namespace {

enum CeilingPurpose : std::uint64_t { rows_of_table = 71 };

/// The lowest and the highest value.
struct Between {
  double low = 0.0;
  double high = 0.0;
  [[nodiscard]] double some(Random& random) const { return random.uniform(low, high); }
};

struct CeilingRow {
  std::string name;
  bool dots_touch = false;
  CeilingKind kind = CeilingKind::tiles;
  Between ceiling_m{1.5, 3.2};
  Between background_gray{90.0, 140.0};
  Between blur_sigma_px{0.4, 0.9};
};

HardScene some_scene(const CeilingRow& row, Random& random) {
  constexpr int markers_aside = 5;
  constexpr double spacing_m = 0.9;
  HardScene scene;
  scene.ceiling_m = row.ceiling_m.some(random);
  scene.light.ceiling = row.kind;
  scene.light.background_gray = row.background_gray.some(random);
  scene.light.blur_sigma_px = row.blur_sigma_px.some(random);
  scene.light.read_noise_gray = random.uniform(1.0, 4.0);
  scene.light.tubes = scene.light.lamps = scene.light.glints = false;
  scene.registry = some_markers(markers_aside, spacing_m, scene.ceiling_m, random);
  return scene;
}

std::vector<CeilingRow> table_rows() {
  std::vector<CeilingRow> rows;
  for (const CeilingKind kind : all_ceiling_kinds)
    rows.push_back({.name = std::string(name_of(kind)), .kind = kind});
  rows.push_back({.name = "touching: defocused",
                  .dots_touch = true,
                  .ceiling_m = {1.8, 3.0},
                  .background_gray = {30.0, 90.0},
                  .blur_sigma_px = {1.5, 2.5}});
  rows.push_back({.name = "touching: far away",
                  .dots_touch = true,
                  .ceiling_m = {3.5, 5.0},
                  .background_gray = {30.0, 90.0},
                  .blur_sigma_px = {0.8, 1.4}});
  rows.push_back({.name = "touching: far, defocused",
                  .dots_touch = true,
                  .ceiling_m = {3.0, 4.2},
                  .background_gray = {30.0, 90.0},
                  .blur_sigma_px = {1.4, 2.5}});
  return rows;
}

}  // namespace

std::vector<CeilingScenes> ceiling_scenes() {
  std::vector<CeilingScenes> scenes;
  for (const CeilingRow& row : table_rows()) {
    scenes.push_back(
        {row.name,
         row.dots_touch,
         {.scene = [row](Random& random) { return some_scene(row, random); },
          .view = [](const HardScene& scene, Random& random) { return some_tilted_view(scene, random); }}});
  }
  return scenes;
}

std::size_t ceiling_rows() {
  return table_rows().size();
}

std::vector<CeilingCounts> count_ceilings(const MethodChoice& choice, int frames, std::uint64_t seed,
                                          const std::function<void(int frames)>& done) {
  std::vector<CeilingCounts> rows;
  const Random random = Random(seed).stream(rows_of_table);
  for (const CeilingScenes& scenes : ceiling_scenes()) {
    rows.push_back({scenes.name, scenes.dots_touch,
                    count_frames(scenes.source, choice, frames, random.stream(rows.size()), done)});
  }
  return rows;
}

}  // namespace lodestar
