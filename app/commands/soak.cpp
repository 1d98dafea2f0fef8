#include <atomic>
#include <filesystem>
#include <fmt/core.h>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/commands/commands.hpp"
#include "app/common/interruption.hpp"
#include "app/common/json_text.hpp"
#include "app/common/log.hpp"
#include "app/common/process_health.hpp"
#include "app/common/stopwatch.hpp"
#include "app/console/document_api.hpp"
#include "app/net/http_server.hpp"
#include "app/report/run_folder.hpp"
#include "app/simulate/simulated_drive.hpp"
#include "app/site/site_folder.hpp"
#include "maps/atomic_file.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

struct SoakArguments {
  std::string site;
  double minutes = 60.0;
  bool realtime = false;
  unsigned short port = 0;
  std::string output = "runs/soak";
};

struct SoakResult {
  ProcessHealth warm;  ///< after a quarter of the time
  ProcessHealth last;
  int missions = 0;
  int failed = 0;
  TimeHistogram computing;  ///< of each step of the navigator
  TimeHistogram period;     ///< from one step to the next, in real time only
};

/// An HTTP server on a thread of its own, for the lifetime of this object.
class BackgroundConsole {
 public:
  BackgroundConsole(const fs::path& site, const fs::path& runs, unsigned short port)
      : documents_(site, runs),
        server_({.access = {.bind = "127.0.0.1", .port = port}, .takes_long = DocumentApi::takes_long},
                [this](const HttpRequest& request) { return documents_.answer(request); }),
        thread_([this] {
          while (!stopping_) server_.run_for(std::chrono::milliseconds(100));
        }) {}
  ~BackgroundConsole() {
    stopping_ = true;
    thread_.join();
  }
  BackgroundConsole(const BackgroundConsole&) = delete;
  BackgroundConsole& operator=(const BackgroundConsole&) = delete;

  [[nodiscard]] unsigned short port() const { return server_.port(); }

 private:
  DocumentApi documents_;
  HttpServer server_;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
};

double growth_percent(const SoakResult& result) {
  if (result.warm.resident_kb == 0) return 0.0;
  return 100.0 * static_cast<double>(result.last.resident_kb - result.warm.resident_kb) /
         static_cast<double>(result.warm.resident_kb);
}

nlohmann::ordered_json times(const TimeHistogram& histogram) {
  const auto at = [&](double share) {
    const std::optional<double> ms = histogram.quantile_ms(share);
    return ms ? nlohmann::ordered_json(*ms) : nlohmann::ordered_json(nullptr);
  };
  return {{"count", histogram.count()}, {"p50", at(0.5)}, {"p99_9", at(0.999)}, {"max", histogram.max_ms()}};
}

nlohmann::ordered_json as_json(const SoakResult& result, double minutes) {
  return {{"minutes", minutes},
          {"missions", result.missions},
          {"failed", result.failed},
          {"resident_kb_warm", result.warm.resident_kb},
          {"resident_kb", result.last.resident_kb},
          {"growth_percent", growth_percent(result)},
          {"descriptors_warm", result.warm.descriptors},
          {"descriptors", result.last.descriptors},
          {"computing_ms", times(result.computing)},
          {"period_ms", times(result.period)}};
}

SimulatedDriveOptions mission(const Site& site, const SoakArguments& arguments, SoakResult& result) {
  SimulatedDriveOptions options{
      .camera = site.default_camera, .goals = site.goals, .realtime = arguments.realtime};
  const auto last = std::make_shared<std::optional<std::chrono::steady_clock::time_point>>();
  options.on_step = [&result, last, realtime = arguments.realtime](std::chrono::nanoseconds computing) {
    const auto now = std::chrono::steady_clock::now();
    result.computing.add(computing);
    if (realtime && *last) result.period.add(now - **last);
    *last = now;
  };
  return options;
}

ExitCode soak(const SoakArguments& arguments) {
  const fs::path folder = site_folder(arguments.site);
  const Site site = load_site(folder);
  make_run_folder(arguments.output);
  const BackgroundConsole console(folder, arguments.output, arguments.port);
  fmt::print("http://127.0.0.1:{}/\n", console.port());
  std::fflush(stdout);

  const Interruption interruption;
  const Stopwatch watch;
  const double seconds_per_minute = 60.0;
  const double wanted_s = seconds_per_minute * arguments.minutes;
  constexpr double warm_share = 0.25;
  SoakResult result;
  while (watch.seconds() < wanted_s && !Interruption::asked()) {
    SimulatedDriveOptions options = mission(site, arguments, result);
    options.goes_on = [] { return !Interruption::asked(); };
    options.seed = static_cast<std::uint64_t>(result.missions + 1);
    const RunRecord record = simulate_drive(site, options);
    if (Interruption::asked()) break;  // perhaps in the middle of this drive
    ++result.missions;
    if (!record.arrived() || record.contacts > 0) {
      ++result.failed;
      log_warning(
          fmt::format("mission {}: {}", result.missions, record.contacts > 0 ? "a contact" : "not arrived"));
    }
    result.last = process_health();
    if (result.warm.resident_kb == 0 && watch.seconds() >= warm_share * wanted_s) result.warm = result.last;
    write_file_atomically(fs::path(arguments.output) / "soak.json",
                          json_document(as_json(result, watch.seconds() / seconds_per_minute)));
  }
  fmt::print("{}", json_document(as_json(result, watch.seconds() / seconds_per_minute)));
  if (watch.seconds() < wanted_s) {
    fmt::print(stderr, "lodestar: interrupted after {:.1f} of {:g} minutes\n",
               watch.seconds() / seconds_per_minute, arguments.minutes);
    return job_failed;
  }
  constexpr double most_growth_percent = 1.0;
  constexpr int descriptors_of_clients = 32;  // connected clients
  const bool is_fine = result.failed == 0 && growth_percent(result) < most_growth_percent &&
                       result.last.descriptors <= result.warm.descriptors + descriptors_of_clients;
  return is_fine ? done : job_failed;
}

}  // namespace

std::vector<Command> soak_commands(CLI::App& lodestar) {
  const auto arguments = std::make_shared<SoakArguments>();
  CLI::App* command = lodestar.add_subcommand("soak",
                                              "Simulate drives for hours with the console served; exit 1 "
                                              "when memory or descriptors grow, or a drive fails");
  command->add_option("site", arguments->site, "Site folder; default: the lab");
  command->add_option("--minutes", arguments->minutes, "Duration in minutes")
      ->check(CLI::Range(0.01, 1e6))
      ->capture_default_str();
  command->add_flag("--realtime", arguments->realtime, "Simulate no faster than real time");
  command->add_option("--port", arguments->port, "Port of the console; 0: any free one")
      ->capture_default_str();
  command->add_option("-o,--output", arguments->output, "Folder of soak.json")->capture_default_str();
  return {{command, [arguments] { return soak(*arguments); }}};
}

}  // namespace lodestar
