#include "app/site/fleet_settings.hpp"

#include <gtest/gtest.h>

#include "maps/input_error.hpp"

namespace lodestar {
namespace {

FleetSettings settings_of(const std::string& text) {
  return read_fleet_settings(StrictYaml::parse(text, "site.yaml"), "/srv/site");
}

const std::string least =
    "broker: mqtts://fleet.example\ninterface: uagv\nmanufacturer: ACME\nserial: r-1\nversion: 2.1.0\n";

TEST(FleetSettings, names_files_relative_to_the_site) {
  const FleetSettings settings = settings_of(least + "ca_file: ca.pem\nuser: robot\n");
  EXPECT_EQ(settings.ca_file, "/srv/site/ca.pem");
  EXPECT_EQ(settings.user, "robot");
  EXPECT_EQ(settings.version, "2.1.0");
}

TEST(FleetSettings, refuses_what_no_topic_may_have_and_half_a_certificate) {
  EXPECT_NO_THROW((void)settings_of(least));
  EXPECT_THROW((void)settings_of(least + "port: 1\n"), InputError);
  EXPECT_THROW((void)settings_of(least + "key_file: k.pem\n"), InputError);
  for (const auto& [right, wrong] : std::vector<std::pair<std::string, std::string>>{
           {"ACME", "A/B"}, {"r-1", "'#'"}, {"2.1.0", "3.0.0"}, {"mqtts://fleet", "mqtt://fleet"}}) {
    std::string text = least;
    text.replace(text.find(right), right.size(), wrong);
    EXPECT_THROW((void)settings_of(text), InputError) << text;
  }
}

TEST(FleetSettings, want_encryption_to_another_machine) {
  EXPECT_EQ(broker_address("mqtts://fleet.example").port, 8883);
  EXPECT_EQ(broker_address("mqtts://[fd00::1]:99").host, "fd00::1");
  EXPECT_EQ(broker_address("mqtt://localhost").port, 1883);
  EXPECT_FALSE(broker_address("mqtt://127.0.0.1:1").has_tls);
  for (const char* url : {"", "fleet", "mqtt://fleet.example", "mqtts://", "mqtts://a:0", "mqtts://a:99999",
                          "mqtts://u@a", "mqtts://[fd00::1", "tcp://localhost", "mqtt://127.evil.example"})
    EXPECT_THROW((void)broker_address(url), InputError) << url;
}

TEST(BatteryCurve, is_linear_between_its_points) {
  const BatteryCurve curve =
      read_battery_curve(StrictYaml::parse("volts: [22, 24, 26]\npercent: [0, 20, 100]\n", "robot.yaml"));
  EXPECT_DOUBLE_EQ(curve.percent_at(20.0), 0.0);
  EXPECT_DOUBLE_EQ(curve.percent_at(23.0), 10.0);
  EXPECT_DOUBLE_EQ(curve.percent_at(25.0), 60.0);
  EXPECT_DOUBLE_EQ(curve.percent_at(30.0), 100.0);
  for (const char* text : {"volts: [22]\npercent: [0]\n", "volts: [22, 22]\npercent: [0, 1]\n",
                           "volts: [22, 23]\npercent: [0]\n", "volts: [22, 23]\npercent: [50, 40]\n",
                           "volts: [22, 23]\npercent: [0, 101]\n"})
    EXPECT_THROW((void)read_battery_curve(StrictYaml::parse(text, "robot.yaml")), InputError) << text;
}

}  // namespace
}  // namespace lodestar
