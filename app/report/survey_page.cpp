#include "app/report/survey_page.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "app/placement/survey_report.hpp"
#include "app/report/page.hpp"
#include "app/report/plot.hpp"
#include "app/report/table.hpp"

namespace lodestar {
namespace {

constexpr double width_px = 1000.0;
constexpr double margin_px = 45.0;
constexpr double magnified = 100.0;  ///< of the ellipses
constexpr double blind_m = 0.6;      ///< keyframes farther apart than this saw nothing between

/// From the survey's frame to the drawing, y up.
class Drawing {
 public:
  explicit Drawing(const MarkerSurvey& survey) {
    for (const RegisteredMarker& marker : survey.markers) box_.extend(Vec2(marker.position_m.head<2>()));
    for (const Pose2& place : survey.path) box_.extend(place.position_m);
    scale_ = (width_px - 2.0 * margin_px) / std::max(box_.sizes().maxCoeff(), 0.1);
  }

  [[nodiscard]] Vec2 at(const Vec2& point_m) const {
    return {margin_px + scale_ * (point_m.x() - box_.min().x()),
            margin_px + scale_ * (box_.max().y() - point_m.y())};
  }
  [[nodiscard]] double px(double length_m) const { return scale_ * length_m; }
  [[nodiscard]] double height_px() const { return 2.0 * margin_px + scale_ * box_.sizes().y(); }

 private:
  Eigen::AlignedBox2d box_;
  double scale_ = 1.0;
};

std::string line(const Vec2& from, const Vec2& to, const char* style) {
  return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" style=\"{}\"/>\n",
                     from.x(), from.y(), to.x(), to.y(), style);
}

/// The way between keyframes; stretches without any marker in view dashed.
std::string way(const MarkerSurvey& survey, const Drawing& drawing) {
  std::string svg;
  for (std::size_t i = 1; i < survey.path.size(); ++i) {
    const Vec2& from = survey.path[i - 1].position_m;
    const Vec2& to = survey.path[i].position_m;
    const bool is_blind = (to - from).norm() > blind_m;
    svg +=
        line(drawing.at(from), drawing.at(to),
             is_blind ? "stroke:#c33;stroke-width:1.5;stroke-dasharray:4 4" : "stroke:#b3b;stroke-width:1");
  }
  return svg;
}

std::string links(const MarkerSurvey& survey, const Drawing& drawing) {
  const auto at = [&](int id) {
    const auto marker = std::ranges::find(survey.markers, id, &RegisteredMarker::id);
    return drawing.at(marker->position_m.head<2>());
  };
  std::string svg;
  for (const SurveyLink& link : survey.links)
    svg += line(at(link.first), at(link.second), "stroke:#e07000;stroke-width:1.5;opacity:.5");
  return svg;
}

std::string ellipse(const MarkerSurvey& survey, std::size_t index, const Drawing& drawing) {
  const auto row = 3 * static_cast<Eigen::Index>(index);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(survey.covariance.block<2, 2>(row, row));
  const Vec2 long_axis = axes.eigenvectors().col(1);
  const Vec2 at = drawing.at(survey.markers[index].position_m.head<2>());
  const auto radius_px = [&](Eigen::Index axis) {
    return std::max(3.0, drawing.px(magnified * std::sqrt(std::max(0.0, axes.eigenvalues()[axis]))));
  };
  return fmt::format(
      "<ellipse cx=\"{0:.1f}\" cy=\"{1:.1f}\" rx=\"{2:.1f}\" ry=\"{3:.1f}\" transform=\"rotate({4:.1f} "
      "{0:.1f} "
      "{1:.1f})\" style=\"fill:#1d6b34;fill-opacity:.25;stroke:#1d6b34\"/>\n"
      "<text x=\"{0:.1f}\" y=\"{5:.1f}\" text-anchor=\"middle\" "
      "style=\"font-size:12px;fill:currentColor\">{6}</text>\n",
      at.x(), at.y(), radius_px(1), radius_px(0), -degrees(heading_of(long_axis)), at.y() - 10.0,
      survey.markers[index].id);
}

std::string drawing_of(const MarkerSurvey& survey) {
  const Drawing drawing(survey);
  std::string svg = fmt::format(
      "<svg viewBox=\"0 0 {:.0f} {:.0f}\" style=\"width:100%\" role=\"img\" "
      "aria-label=\"Markers, links and the robot's way\">\n",
      width_px, drawing.height_px());
  svg += way(survey, drawing) + links(survey, drawing);
  if (survey.covariance.rows() == 3 * static_cast<Eigen::Index>(survey.markers.size()))
    for (std::size_t i = 0; i < survey.markers.size(); ++i) svg += ellipse(survey, i, drawing);
  const Vec2 bar(margin_px, drawing.height_px() - 12.0);
  svg += line(bar, bar + Vec2(drawing.px(1.0), 0.0), "stroke:currentColor;stroke-width:2");
  svg += fmt::format(
      "<text x=\"{:.1f}\" y=\"{:.1f}\" style=\"font-size:12px;fill:currentColor\">1 m; ellipses: one "
      "sigma, {:.0f} times</text></svg>\n",
      bar.x() + drawing.px(1.0) + 8.0, bar.y() + 4.0, magnified);
  return svg;
}

/// Values in rising order over their rank.
std::string ranked(const std::string& title, const std::string& unit, std::vector<double> values) {
  std::ranges::sort(values);
  PlotSeries series{.name = "markers, sorted", .css_class = "a", .points = {}};
  for (std::size_t i = 0; i < values.size(); ++i)
    series.points.emplace_back(static_cast<double>(i + 1), values[i]);
  return plot_svg(title, unit, {series}, {.x_name = "number of markers"});
}

Table table_of(const MarkerSurvey& survey) {
  Table table{.title = "Markers",
              .header = {"ID", "x m", "y m", "z m", "yaw deg", "sigma mm", "sigma deg", "places", "fit"},
              .rows = {}};
  for (std::size_t i = 0; i < survey.markers.size(); ++i) {
    const RegisteredMarker& marker = survey.markers[i];
    const MarkerSigma sigma = marker.sigma.value_or(MarkerSigma{});
    table.rows.push_back(
        {std::to_string(marker.id), fmt::format("{:.4f}", marker.position_m.x()),
         fmt::format("{:.4f}", marker.position_m.y()), fmt::format("{:.4f}", marker.position_m.z()),
         fmt::format("{:.3f}", degrees(marker.yaw_rad)), fmt::format("{:.2f}", mm_per_m * sigma.position_m),
         fmt::format("{:.3f}", degrees(sigma.yaw_rad)), std::to_string(survey.sightings[i]),
         fmt::format("{:.2f}", survey.dots_fit[i])});
  }
  return table;
}

}  // namespace

std::string survey_html(const MarkerSurvey& survey, const std::string& title) {
  const std::string report = text_report(survey);
  std::string body = fmt::format("<h1>{}</h1>\n<pre>{}</pre>\n", escaped(title),
                                 escaped(report.substr(0, report.find("\n\n"))));
  for (const std::string& line : complaints(survey)) body += "<p>" + escaped(line) + "</p>\n";
  body += drawing_of(survey);
  std::vector<double> sigmas_mm;
  for (const RegisteredMarker& marker : survey.markers)
    sigmas_mm.push_back(mm_per_m * marker.sigma.value_or(MarkerSigma{}).position_m);
  body += ranked("Sigma of x and y", "mm", sigmas_mm);
  body += ranked("Squared residuals of the dots over their sigmas", "1", survey.dots_fit);
  return page_html(title, body + html_of(table_of(survey)));
}

}  // namespace lodestar
