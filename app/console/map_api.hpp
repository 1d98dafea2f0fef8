#pragma once

#include <atomic>
#include <functional>
#include <optional>

#include "app/console/audit_log.hpp"
#include "app/net/http.hpp"
#include "app/site/site.hpp"

namespace lodestar {

/// Part of the document API: a map that a person has drawn on.
///
///   PUT  /api/map/cells   {cells}: base64 of one byte a cell, as GET gives them, with If-Match
///
/// What was before is kept in .history/map of the site's folder. The site is loaded anew after it: what is
/// served is what was loaded.
class MapApi {
 public:
  /// `site` must outlive this.
  MapApi(const Site& site, AuditLog& audit) : site_(site), audit_(audit) {}

  /// Nothing for another document.
  [[nodiscard]] std::optional<HttpResponse> answer(const HttpRequest& request) const;

  /// Called when a map has been saved, from the thread that answers. Without it none may be: a robot that
  /// runs on a map keeps it.
  void on_saved(std::function<void()> tell) { on_saved_ = std::move(tell); }

 private:
  [[nodiscard]] HttpResponse save(const HttpRequest& request) const;
  void keep_present() const;

  const Site& site_;
  AuditLog& audit_;
  std::function<void()> on_saved_;
  mutable std::atomic<bool> is_saved_ = false;
};

}  // namespace lodestar
