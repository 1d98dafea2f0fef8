#pragma once

#include "app/bench/evidence.hpp"

// What the commands of `bench all` print, as rows. All throw std::exception for an output of another form.
namespace lodestar {

std::vector<EvidenceRow> localize_rows(const std::string& output);  ///< bench localize --json
std::vector<EvidenceRow> paper_rows(const std::string& output);     ///< bench paper --json
std::vector<EvidenceRow> octile_rows(const std::string& output);    ///< bench plan --map --scen --json
std::vector<EvidenceRow> map_rows(const std::string& output);       ///< bench plan --generated --json
std::vector<EvidenceRow> site_rows(const std::string& output);      ///< bench plan --site --json
std::vector<EvidenceRow> survey_rows(const std::string& output);    ///< bench survey --json
std::vector<EvidenceRow> spoiled_rows(const std::string& output);   ///< bench survey --spoiled --json
std::vector<EvidenceRow> campaign_rows(const std::string& output);  ///< campaign, with or without people
std::vector<EvidenceRow> scenario_rows(const std::string& output);  ///< scenario --json
std::vector<EvidenceRow> scan_rows(const std::string& output);      ///< control_bench, as JSON
std::vector<EvidenceRow> timing_rows(const std::string& output);    ///< other benchmarks, without a limit

}  // namespace lodestar
