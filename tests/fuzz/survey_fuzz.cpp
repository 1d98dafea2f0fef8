#include "app/frames/survey_log_file.hpp"
#include "maps/anchors.hpp"
#include "maps/input_error.hpp"
#include "maps/paper_camera.hpp"

#include "tests/fuzz/scratch_file.hpp"

// The first byte chooses: anchors, or the dots of a log. Either is refused with an InputError or read whole.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lodestar;
  if (size == 0) return 0;
  const bool is_anchors = data[0] == 'a';
  const std::filesystem::path file =
      scratch_file(is_anchors ? "anchors.yaml" : "dots.csv", data + 1, size - 1);
  std::ofstream(file.parent_path() / "wheels.csv") << "stamp_s,left_m,right_m\n0,0,0\n1,0.5,0.5\n";
  try {
    if (is_anchors) {
      for (const Anchor& anchor : load_anchors(file).anchors)
        if (to_string(anchor).empty()) __builtin_trap();
      return 0;
    }
    const SurveyLog log = load_survey_log(file.parent_path(), paper_camera());
    for (const SurveyFrame& frame : log.frames)
      if (frame.markers.empty()) __builtin_trap();
  } catch (const InputError&) {
    return 0;
  }
  return 0;
}
