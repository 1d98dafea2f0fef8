#pragma once

#include <filesystem>
#include <functional>

#include "app/console/accepted_api.hpp"
#include "app/console/audit_log.hpp"
#include "app/console/document_history.hpp"
#include "app/console/hanging_api.hpp"
#include "app/console/map_api.hpp"
#include "app/console/places_api.hpp"
#include "app/console/runs_api.hpp"
#include "app/console/site_coverage.hpp"
#include "app/net/http.hpp"
#include "app/site/site.hpp"

namespace lodestar {

/// The console's documents over HTTP, under fixed names; a client's path never reaches the file system:
///
///   GET  /, /app.js, ...          the page
///   GET  /api/site                 name, robot, start, goals, usual routes, what the camera covers
///   GET  /api/map                  size, resolution, origin
///   GET  /api/map/cells            one byte a cell, bottom row first
///   PUT  /api/map/cells            MapApi
///   GET  /api/map/heights          of an OctoMap: four bytes a cell, little-endian
///   GET  /api/markers              the registry
///   PUT  /api/markers              saves it, with If-Match: 412 when someone else saved
///   GET  /api/markers/history      earlier versions: [{number, at, by}], the newest first
///   GET  /api/markers/history/N    one of them
///   POST /api/markers/check        the issues of a draft
///   POST /api/markers/deviations   expected standard deviation of a fix under a draft
///   POST /api/markers/export       {format, registry} -> {text}
///   POST /api/markers/import       {name, text} -> a registry
///   POST /api/markers/print        {ids, paper} -> a PDF
///   POST /api/markers/plan         where a draft's markers hang -> {text}: the table of `markers plan`
///   /api/places..., /api/routes    what people name on the map: PlacesApi
///   /api/hanging...                what hangs already: HangingApi
///   PUT  /api/accepted             a warning that may stand: AcceptedApi
///   GET  /api/log                  who drove and who saved: AuditLog
///   /api/runs..., /api/heat        former runs: RunsApi
///
/// Documents have an ETag; GET with If-None-Match gives 304. Anything else is 404.
class DocumentApi {
 public:
  /// Throws InputError for an unusable site. `runs_folder` need not exist.
  DocumentApi(const std::filesystem::path& site_folder, const std::filesystem::path& runs_folder);

  [[nodiscard]] HttpResponse answer(const HttpRequest& request) const;

  /// Drafts are checked, converted and printed, which takes seconds for thousands of markers. May be answered
  /// beside other requests: it reads only what does not change.
  [[nodiscard]] static bool takes_long(const HttpRequest& head);

  /// Documents are read, written and listed, which takes seconds for long runs and thousands of markers. One
  /// at a time may be answered, beside a draft and beside all other requests.
  [[nodiscard]] static bool uses_files(const HttpRequest& head);

  /// Called with the markers each time a client has saved them, from the thread that answers.
  void on_saved_markers(std::function<void(const MarkerRegistry&)> tell) { on_saved_ = std::move(tell); }

  /// The same for places and zones.
  void on_saved_places(std::function<void(const Places&)> tell) { places_.on_saved(std::move(tell)); }

  /// The same for the map; without it none is taken. The documents must be made anew then.
  void on_saved_map(std::function<void()> tell) { map_.on_saved(std::move(tell)); }

  [[nodiscard]] const Site& site() const { return site_; }

  /// Who drove and who saved.
  [[nodiscard]] AuditLog& audit() const { return audit_; }

 private:
  [[nodiscard]] HttpResponse site_document() const;
  [[nodiscard]] HttpResponse map() const;
  [[nodiscard]] HttpResponse cells() const;
  [[nodiscard]] std::optional<HttpResponse> heights() const;
  [[nodiscard]] HttpResponse markers() const;
  HttpResponse save_markers(const HttpRequest& request) const;
  [[nodiscard]] HttpResponse history(const std::string& target) const;
  [[nodiscard]] HttpResponse post(const HttpRequest& request) const;

  Site site_;
  std::filesystem::path registry_file_;
  DocumentHistory history_;
  mutable AuditLog audit_;
  RunsApi runs_;
  std::function<void(const MarkerRegistry&)> on_saved_;
  SiteCoverage coverage_;
  PlacesApi places_;
  HangingApi hanging_;
  AcceptedApi accepted_;
  MapApi map_;
};

}  // namespace lodestar
