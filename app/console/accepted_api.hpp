#pragma once

#include <filesystem>
#include <optional>

#include "app/console/audit_log.hpp"
#include "app/net/http.hpp"

namespace lodestar {

/// Part of the document API, for warnings accepted with a reason:
///
///   PUT /api/accepted   {kind, ids, places_m, reason}: an issue as /api/markers/check gives it; without a
///   reason it is
///                       a warning again
class AcceptedApi {
 public:
  AcceptedApi(std::filesystem::path site_folder, AuditLog& audit)
      : folder_(std::move(site_folder)), audit_(audit) {}

  /// Nothing for another document.
  [[nodiscard]] std::optional<HttpResponse> answer(const HttpRequest& request) const;

 private:
  [[nodiscard]] HttpResponse set(const HttpRequest& request) const;

  std::filesystem::path folder_;
  AuditLog& audit_;
};

}  // namespace lodestar
