#pragma once

#include <functional>
#include <optional>

#include "app/console/audit_log.hpp"
#include "app/console/document_history.hpp"
#include "app/net/http.hpp"
#include "app/placement/coverage.hpp"
#include "app/site/site.hpp"

namespace lodestar {

/// The part of the document API that reads and writes places.yaml of a site. Both documents have the same
/// ETag, since they are of one file:
///
///   GET  /api/places               all of it as JSON; PUT saves it, with If-Match: 412 when someone else
///                                  saved, 422 with the item to blame
///   GET  /api/places/history       earlier versions, as of markers;  /api/places/history/N  one of them
///   POST /api/places/check         the issues of a draft, as of `lodestar places check`
///   GET  /api/routes               places and missions only; PUT likewise
class PlacesApi {
 public:
  /// All must outlive this; `floor` is what its markers are to cover. Earlier versions are kept in
  /// .history/places of the site's folder.
  PlacesApi(const Site& site, const CoveredFloor& floor, AuditLog& audit);

  /// Nothing for another document.
  [[nodiscard]] std::optional<HttpResponse> answer(const HttpRequest& request) const;

  /// Called with the places each time a client has saved them, from the thread that answers.
  void on_saved(std::function<void(const Places&)> tell) { on_saved_ = std::move(tell); }

 private:
  [[nodiscard]] HttpResponse places() const;
  [[nodiscard]] HttpResponse routes() const;
  [[nodiscard]] HttpResponse save(const HttpRequest& request, const Places& before) const;
  [[nodiscard]] HttpResponse check(const HttpRequest& request) const;
  [[nodiscard]] HttpResponse history(const std::string& rest) const;

  const Site& site_;
  const CoveredFloor& floor_;
  AuditLog& audit_;
  DocumentHistory history_;
  std::function<void(const Places&)> on_saved_;
};

}  // namespace lodestar
