#include "app/drive/range_findings.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <opencv2/core.hpp>

namespace lodestar {
namespace {

/// More of a scan without a reading than a glass front or a black hall takes: dirt, or a cover.
constexpr double most_invalid = 0.6;
constexpr double least_known_depth = 0.2;

Finding look_at_scans(const SeenRanges& seen) {
  if (seen.scans.count == 0) {
    return {.what = "scanner",
            .verdict = Verdict::bad,
            .found = seen.no_scanner.empty() ? "no scan in a second" : seen.no_scanner,
            .remedy = "check its cable and its address in site.yaml: see docs/scanners.md"};
  }
  Finding scanner{.what = "scanner",
                  .found = fmt::format("{} beams a scan, {:.0f} ms old on arrival", seen.beams,
                                       1e3 * seen.scans.mean_age_s())};
  if (const std::optional<double> rate_hz = seen.scans.rate_hz())
    scanner.found += fmt::format(", {:.1f} scans a second", *rate_hz);
  if (!seen.description.empty()) scanner.found += "; it says: " + seen.description;
  const double invalid =
      static_cast<double>(seen.invalid) / static_cast<double>(std::max<std::size_t>(seen.beams, 1));
  if (seen.packets.refused > 0) {
    scanner.verdict = Verdict::doubtful;
    scanner.found += fmt::format("; {} of its packets were damaged", seen.packets.refused);
    scanner.remedy = "check the cable, and the baud rate in site.yaml";
  } else if (invalid > most_invalid) {
    scanner.verdict = Verdict::doubtful;
    scanner.found += fmt::format("; {:.0f} % of the beams bring nothing back", 1e2 * invalid);
    scanner.remedy = "clean its window; take off its cover";
  }
  return scanner;
}

Finding look_at_depths(const SeenRanges& seen) {
  if (seen.depth_images == 0) {
    return {.what = "depth camera",
            .verdict = Verdict::bad,
            .found = seen.no_depth_camera.empty() ? "no image in a second" : seen.no_depth_camera,
            .remedy = "plug it in; check its device in site.yaml"};
  }
  Finding depth{.what = "depth camera",
                .found = fmt::format("{} images in a second, a depth for {:.0f} % of the pixels",
                                     seen.depth_images, 1e2 * seen.known_share)};
  if (!seen.depth_description.empty()) depth.found += "; the driver claims " + seen.depth_description;
  if (seen.known_share < least_known_depth) {
    depth.verdict = Verdict::doubtful;
    depth.remedy = "clean its windows; switch its projector on";
  }
  return depth;
}

}  // namespace

void SeenRanges::take(const Scan& scan, Stamp arrival) {
  if (scan.beams.empty()) return;
  const auto newest = std::ranges::max_element(scan.beams, {}, &Beam::stamp);
  scans.take(newest->stamp, arrival);
  beams = scan.beams.size();
  invalid = static_cast<std::size_t>(std::ranges::count(scan.beams, Echo::invalid, &Beam::echo));
}

void SeenRanges::take(const DepthImage& image) {
  ++depth_images;
  if (!image.depth_mm.empty())
    known_share =
        static_cast<double>(cv::countNonZero(image.depth_mm)) / static_cast<double>(image.depth_mm.total());
}

std::vector<Finding> look_at_ranges(const Robot& robot, const SeenRanges& seen) {
  std::vector<Finding> findings;
  if (robot.scanner) findings.push_back(look_at_scans(seen));
  if (robot.depth_camera) findings.push_back(look_at_depths(seen));
  return findings;
}

}  // namespace lodestar
