#include "app/site/fleet_settings.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fmt/format.h>
#include <set>

#include "maps/input_error.hpp"

namespace lodestar {
namespace {

/// What VDA 5050 allows in topics: letters, digits, '_', '.', ':' and '-'.
std::string read_topic_word(StrictYaml& yaml, const std::string& key) {
  constexpr std::size_t longest = 80;
  const std::string word = yaml.text(key);
  const bool is_word = std::ranges::all_of(word, [](unsigned char c) {
    return c < 0x80 && (std::isalnum(c) != 0 || c == '_' || c == '.' || c == ':' || c == '-');
  });
  if (!is_word || word.empty() || word.size() > longest)
    yaml.refuse(key, "'" + word + "'", "1 to 80 letters, digits, '_', '.', ':' and '-'");
  return word;
}

/// 127.0.0.1 and its like, but no name that only begins so.
bool is_loopback(const std::string& host) {
  const bool is_number = host.find_first_not_of("0123456789.") == std::string::npos;
  return host == "localhost" || host == "::1" || (is_number && host.starts_with("127."));
}

int port_of(const std::string& url, const std::string& text) {
  const bool is_number = !text.empty() && text.size() <= 5 &&
                         std::ranges::all_of(text, [](unsigned char c) { return std::isdigit(c) != 0; });
  const int port = is_number ? std::stoi(text) : 0;
  if (port < 1 || port > 65535)
    throw InputError(fmt::format("broker: found '{}', wanted a port in 1..65535", url));
  return port;
}

/// The values of a list, each finite.
std::vector<double> read_numbers(StrictYaml& yaml, const std::string& key) {
  const YAML::Node list = yaml.node(key);
  if (!list.IsSequence() || list.size() < 2)
    yaml.refuse(key, "something else", "a list of two numbers or more");
  return yaml.numbers_at(key, list, list.size());
}

std::vector<std::string> read_command(StrictYaml& yaml, const std::filesystem::path& folder) {
  const YAML::Node list = yaml.node("run");
  std::vector<std::string> command;
  if (list.IsSequence())
    for (const YAML::Node& word : list)
      if (word.IsScalar()) command.push_back(word.as<std::string>());
  if (command.empty() || command.size() != list.size())
    yaml.refuse("run", "something else", "a list: the program and its arguments");
  command.front() = std::filesystem::absolute(folder / command.front()).string();
  return command;
}

ActionHook read_action_hook(StrictYaml yaml, const std::filesystem::path& folder) {
  constexpr double longest_s = 86400.0;
  const std::set<std::string> own{"wait",         "startPause",   "stopPause",       "cancelOrder",
                                  "initPosition", "stateRequest", "factsheetRequest"};
  ActionHook hook;
  hook.type = read_topic_word(yaml, "type");
  if (own.contains(hook.type))
    yaml.refuse("type", "'" + hook.type + "'", "a type that the robot does not carry out itself");
  hook.command = read_command(yaml, folder);
  hook.timeout = from_seconds(yaml.number("timeout_s", 0.1, longest_s));
  yaml.finish();
  return hook;
}

}  // namespace

BrokerAddress broker_address(const std::string& url) {
  BrokerAddress address;
  std::string rest;
  if (url.starts_with("mqtts://")) {
    rest = url.substr(8);
  } else if (url.starts_with("mqtt://")) {
    rest = url.substr(7);
    address = {.has_tls = false, .host = {}, .port = 1883};
  }
  if (rest.starts_with('[')) {  // IPv6
    const std::size_t end = rest.find(']');
    address.host = end == std::string::npos ? "" : rest.substr(1, end - 1);
    rest = end == std::string::npos ? "" : rest.substr(end + 1);
  } else {
    address.host = rest.substr(0, rest.find(':'));
    rest = rest.substr(address.host.size());
  }
  const bool has_odd_letters = address.host.find_first_of("/@?# ") != std::string::npos;
  if (address.host.empty() || has_odd_letters || (!rest.empty() && rest.front() != ':'))
    throw InputError(fmt::format("broker: found '{}', wanted mqtts://HOST[:PORT]", url));
  if (!rest.empty()) address.port = port_of(url, rest.substr(1));
  if (!address.has_tls && !is_loopback(address.host))
    throw InputError(fmt::format("broker: found '{}', wanted mqtts: to another machine", url));
  return address;
}

std::vector<ActionHook> read_action_hooks(std::vector<StrictYaml> list, const std::filesystem::path& folder) {
  std::vector<ActionHook> hooks;
  for (StrictYaml& action : list) hooks.push_back(read_action_hook(std::move(action), folder));
  return hooks;
}

FleetSettings read_fleet_settings(StrictYaml yaml, const std::filesystem::path& folder) {
  FleetSettings settings;
  settings.broker = yaml.text("broker");
  try {
    (void)broker_address(settings.broker);
  } catch (const InputError&) {
    yaml.refuse("broker", "'" + settings.broker + "'",
                "mqtts://HOST[:PORT], or mqtt://localhost[:PORT] on this machine");
  }
  settings.interface = read_topic_word(yaml, "interface");
  settings.manufacturer = read_topic_word(yaml, "manufacturer");
  settings.serial = read_topic_word(yaml, "serial");
  settings.version = yaml.text("version");
  if (settings.version != "2.0.0" && settings.version != "2.1.0")
    yaml.refuse("version", "'" + settings.version + "'", "2.0.0 or 2.1.0");
  if (yaml.has("map")) settings.map = yaml.text("map");
  if (yaml.has("user")) settings.user = yaml.text("user");
  if (yaml.has("password_file")) settings.password_file = folder / yaml.text("password_file");
  if (yaml.has("ca_file")) settings.ca_file = folder / yaml.text("ca_file");
  if (yaml.has("certificate_file")) settings.certificate_file = folder / yaml.text("certificate_file");
  if (yaml.has("key_file")) settings.key_file = folder / yaml.text("key_file");
  if (settings.certificate_file.empty() != settings.key_file.empty())
    yaml.refuse(settings.key_file.empty() ? "certificate_file" : "key_file", "it alone",
                "certificate_file and key_file together");
  if (yaml.has("actions")) settings.actions = read_action_hooks(yaml.list_of_mappings("actions"), folder);
  yaml.finish();
  return settings;
}

std::optional<FleetSettings> load_fleet_settings(const std::filesystem::path& folder) {
  StrictYaml yaml = StrictYaml::load(folder / "site.yaml");
  if (!yaml.has("fleet")) return std::nullopt;
  FleetSettings settings = read_fleet_settings(yaml.mapping("fleet"), folder);
  if (!yaml.has("actions")) return settings;
  const std::vector<ActionHook> of_site = read_action_hooks(yaml.list_of_mappings("actions"), folder);
  settings.actions.insert(settings.actions.end(), of_site.begin(), of_site.end());
  return settings;
}

double BatteryCurve::percent_at(double battery_v) const {
  if (battery_v <= volts.front()) return percent.front();
  for (std::size_t i = 1; i < volts.size(); ++i) {
    if (battery_v > volts[i]) continue;
    const double share = (battery_v - volts[i - 1]) / (volts[i] - volts[i - 1]);
    return std::lerp(percent[i - 1], percent[i], share);
  }
  return percent.back();
}

BatteryCurve read_battery_curve(StrictYaml yaml) {
  BatteryCurve curve{.volts = read_numbers(yaml, "volts"), .percent = read_numbers(yaml, "percent")};
  const bool rises = std::ranges::adjacent_find(curve.volts, std::greater_equal<>{}) == curve.volts.end();
  if (!rises || curve.volts.front() < 0.0 || curve.volts.back() > 1000.0)
    yaml.refuse("volts", "values that do not rise, or outside of 0..1000", "rising voltages");
  const bool is_share = std::ranges::all_of(curve.percent, [](double p) { return p >= 0.0 && p <= 100.0; });
  if (!is_share || curve.percent.size() != curve.volts.size() || !std::ranges::is_sorted(curve.percent))
    yaml.refuse("percent", "something else", "as many values as volts, in 0..100, none less than before");
  yaml.finish();
  return curve;
}

std::optional<BatteryCurve> load_battery_curve(const std::filesystem::path& robot_file) {
  StrictYaml yaml = StrictYaml::load(robot_file);
  if (!yaml.has("battery")) return std::nullopt;
  return read_battery_curve(yaml.mapping("battery"));
}

}  // namespace lodestar
