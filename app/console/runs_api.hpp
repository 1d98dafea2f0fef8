#pragma once

#include <optional>

#include "app/console/run_archive.hpp"
#include "app/net/http.hpp"

namespace lodestar {

/// The part of the document API that shows former runs, for one request at a time:
///
///   GET /api/runs                       what a list shows of each, the newest last
///   GET /api/runs/NAME                  one of them
///   GET /api/runs/NAME/cells            of the map that it drove on
///   GET /api/runs/NAME/pictures/T.jpg
///   GET /api/heat                       where the newest runs of the site went badly
class RunsApi {
 public:
  RunsApi(std::filesystem::path folder, std::string site)
      : runs_(std::move(folder)), site_(std::move(site)) {}

  /// Nothing for another document.
  [[nodiscard]] std::optional<HttpResponse> answer(const HttpRequest& request) const;

 private:
  /// `rest`: what follows /api/runs/.
  [[nodiscard]] HttpResponse one(std::string_view rest) const;

  RunArchive runs_;
  std::string site_;
};

}  // namespace lodestar
