#include <gmock/gmock.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "tests/scenarios/command_line.hpp"

// From an empty folder to the first drive, as a person calls the commands.
namespace lodestar {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

TEST(SiteNew, from_a_plan_to_the_first_drive) {
  const ScratchFolder scratch;
  cv::Mat plan(300, 500, CV_8U, cv::Scalar(255));
  cv::rectangle(plan, cv::Rect(50, 50, 401, 201), cv::Scalar(0), 2);
  cv::line(plan, {250, 50}, {250, 150}, cv::Scalar(0), 2);  // a wall with a passage
  cv::imwrite((scratch.path() / "plan.png").string(), plan);
  const auto run = [&](const std::string& words) { return run_lodestar(words, scratch.path()); };

  const Ran no_scale = run("site new plan.png -o hall");
  EXPECT_EQ(no_scale.exit_code, 2);
  EXPECT_THAT(no_scale.err, HasSubstr("without a scale"));
  const std::string make = "site new plan.png -o hall --points 50,50,450,50 --distance 8";
  const Ran made = run(make);
  EXPECT_EQ(made.exit_code, 0) << made.err;
  EXPECT_THAT(made.out, HasSubstr("lodestar markers fill hall"));
  EXPECT_EQ(run(make).exit_code, 2);  // nothing is overwritten

  const Ran filled = run("markers fill hall");
  EXPECT_EQ(filled.exit_code, 0) << filled.err;
  const std::string registry = read_text(scratch.path() / "hall/markers.yaml");
  EXPECT_THAT(run("markers fill hall").out, HasSubstr("0 markers added"));
  EXPECT_EQ(read_text(scratch.path() / "hall/markers.yaml"), registry);
  const Ran checked = run("markers check --site hall");
  EXPECT_EQ(checked.exit_code, 0) << checked.out;
  EXPECT_THAT(run("markers plan hall --date 2026-01-02").out, HasSubstr(",down,hall,2026-01-02\n"));

  const Ran driven = run("replay hall --quiet -o out");
  EXPECT_EQ(driven.exit_code, 0) << driven.out << driven.err;
  EXPECT_THAT(driven.out, HasSubstr("reached"));
}

}  // namespace
}  // namespace lodestar
