#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "app/console/audit_log.hpp"
#include "app/console/document_history.hpp"
#include "app/net/http.hpp"
#include "maps/marker_registry.hpp"

// Who changed what, and when, as the page sees it.
namespace lodestar {

/// Earlier versions of a document, the newest first: [{"number", "at", "by"}], the time (UTC) at which it was
/// saved over and by whom, which may be empty.
nlohmann::ordered_json history_json(const DocumentHistory& history, const AuditLog& audit,
                                    const std::string& document);

/// The name that the request's user goes by, without control characters and cut to 40 bytes; empty for none.
std::string name_of(const HttpRequest& request);

/// "2 changed, 1 added, 0 removed".
std::string changes_in_words(const MarkerRegistry& before, const MarkerRegistry& after);

}  // namespace lodestar
