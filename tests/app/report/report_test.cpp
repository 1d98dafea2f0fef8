#include "app/report/report.hpp"

#include <gtest/gtest.h>

#include "app/report/plot.hpp"

#include "tests/app/sample_run.hpp"

namespace lodestar {
namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(Report, tells_site_goals_and_how_to_repeat_the_run) {
  const std::string html = report_html(sample::run(), "png");
  EXPECT_TRUE(has(html, "yard: arrived"));
  EXPECT_TRUE(has(html, "<code>lodestar replay yard --seed 5</code>"));
  EXPECT_TRUE(has(html, "3.00, 1.00"));
  EXPECT_TRUE(has(html, "4.0 mm"));
  EXPECT_EQ(count_of(html, "<svg"), 9U);
}

TEST(Report, carries_its_picture_and_loads_nothing) {
  // The three paddings of base64 (RFC 4648, section 10).
  EXPECT_TRUE(has(report_html(sample::run(), "foo"), "base64,Zm9v\""));
  EXPECT_TRUE(has(report_html(sample::run(), "foob"), "base64,Zm9vYg==\""));
  const std::string html = report_html(sample::run(), "fooba");
  EXPECT_TRUE(has(html, "base64,Zm9vYmE=\""));
  for (const char* outside : {"http:", "https:", "<script", "<link", "url("}) {
    EXPECT_FALSE(has(html, outside)) << outside;
  }
}

TEST(Report, escapes_what_comes_from_outside) {
  RunRecord record = sample::run();
  record.site = "<b>&";
  record.repeat = "x \"<script>\"";
  record.goals[1].arrived = false;
  record.goals[1].failure = "'<i>'";
  const std::string html = report_html(record, "png");
  EXPECT_FALSE(has(html, "<b>") || has(html, "<script>") || has(html, "<i>"));
  EXPECT_TRUE(has(html, "&lt;b&gt;&amp;: not arrived"));
  EXPECT_TRUE(has(html, "not reached: &#39;&lt;i&gt;&#39;"));
}

TEST(Report, of_a_run_without_a_step_is_still_a_page) {
  const std::string html = report_html(RunRecord{}, "");
  EXPECT_TRUE(has(html, "</html>"));
  EXPECT_FALSE(has(html, "nan"));
  EXPECT_FALSE(has(html, "inf"));
}

TEST(Report, of_a_long_run_stays_small) {
  RunRecord record = sample::run();
  const StepRecord step = record.steps.back();
  for (int i = 0; i < 100000; ++i) {
    record.steps.push_back(step);
    record.steps.back().estimate.stamp += from_seconds(0.01 * i);
    record.fixes.push_back({sample::at_s(0.01 * i), {}, {}, i % 2 == 0 ? 0.2 : 0.9, true});
  }
  EXPECT_LT(report_html(record, "").size(), 300000U);
}

TEST(Plot, keeps_a_single_outlier_of_many_points) {
  PlotSeries series{"error", "a", {}, false};
  for (int i = 0; i < 50000; ++i) series.points.emplace_back(i, i == 31234 ? 100.0 : 1.0);
  const std::string with = plot_svg("t", "mm", {series});
  series.points[31234].y() = 1.0;
  series.points.front().y() = 100.0;  // the same axes, the peak elsewhere
  const std::string without = plot_svg("t", "mm", {series});
  // x of the outlier: 60 px margin and its share of the 828 px between the margins.
  EXPECT_TRUE(has(with, "577.2,")) << "60 + 828 * 31234 / 49999";
  EXPECT_NE(with, without);
}

}  // namespace
}  // namespace lodestar
