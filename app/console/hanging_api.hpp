#pragma once

#include <optional>

#include "app/console/audit_log.hpp"
#include "app/net/http.hpp"
#include "app/site/site.hpp"

namespace lodestar {

/// Part of the document API, for who hangs the markers:
///
///   GET  /api/hanging           [{id, x_m, y_m, z_m, yaw_deg, walls: {left, right, below, above}, state, by,
///                               at, photo}], each saved marker on the map; distances in metres, null where
///                               there is no wall
///   PUT  /api/hanging/ID        {state, by}: planned, hung or verified
///   PUT  /api/hanging/ID/photo  {jpeg}, base64
///   GET  /api/hanging/ID.jpg
///
/// Each marker by itself: two people on two ladders do not get in each other's way.
class HangingApi {
 public:
  /// `site` must outlive this. Photos are kept in photos/ of its folder.
  HangingApi(const Site& site, AuditLog& audit) : site_(site), audit_(audit) {}

  /// Nothing for another document.
  [[nodiscard]] std::optional<HttpResponse> answer(const HttpRequest& request) const;

 private:
  [[nodiscard]] HttpResponse list() const;
  [[nodiscard]] HttpResponse set(int id, const HttpRequest& request) const;
  [[nodiscard]] HttpResponse keep_photo(int id, const HttpRequest& request) const;
  [[nodiscard]] HttpResponse photo(int id) const;
  [[nodiscard]] std::filesystem::path photo_file(int id) const;

  const Site& site_;
  AuditLog& audit_;
};

}  // namespace lodestar
