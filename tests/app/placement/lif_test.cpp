#include "app/placement/lif.hpp"

#include <gmock/gmock.h>

#include "maps/input_error.hpp"

namespace lodestar {
namespace {

using nlohmann::ordered_json;
using testing::ElementsAre;
using testing::HasSubstr;

const LifHeader header{.project = "lab", .vehicle_type = "nurse", .exported_at = "2026-01-02T03:04:05.00Z"};

Places graph() {
  return {.places = {{"desk", {2.5, 5.0}, radians(90.0)}, {"door", {13.5, 2.0}, std::nullopt}},
          .nodes = {{"N1", {1.7, 5.0}}},
          .edges = {{.from = "N1", .to = "desk", .one_way = true, .max_mps = 0.3},
                    {.from = "desk", .to = "door", .one_way = false, .max_mps = std::nullopt}}};
}

std::string refusal(const std::string& text, const LifChoice& choice = {}) {
  try {
    (void)read_lif(text, "hall.lif", choice);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Lif, has_what_the_format_requires) {
  const ordered_json lif = lif_of(graph(), header);
  EXPECT_EQ(lif["metaInformation"]["lifVersion"], "1.0.0");
  const ordered_json& layout = lif["layouts"][0];
  ASSERT_EQ(layout["nodes"].size(), 3U);
  EXPECT_EQ(layout["nodes"][0]["nodeId"], "desk");
  EXPECT_DOUBLE_EQ(layout["nodes"][0]["vehicleTypeNodeProperties"][0]["theta"].get<double>(), radians(90.0));
  EXPECT_FALSE(layout["nodes"][1]["vehicleTypeNodeProperties"][0].contains("theta"));
  ASSERT_EQ(layout["edges"].size(), 3U);  // the way back is one of its own
  EXPECT_EQ(layout["edges"][0]["vehicleTypeEdgeProperties"][0]["maxSpeed"], 0.3);
  EXPECT_EQ(layout["edges"][2]["startNodeId"], "door");
  EXPECT_EQ(layout["edges"][2]["endNodeId"], "desk");
  EXPECT_EQ(layout["stations"].size(), 2U);
  EXPECT_EQ(layout["stations"][1]["interactionNodeIds"], ordered_json::array({"door"}));
}

TEST(Lif, comes_back_as_it_went) {
  const ImportedLif read = read_lif(lif_of(graph(), header).dump(), "lab.lif");
  EXPECT_EQ(places_text(read.places), places_text(graph()));
  EXPECT_THAT(read.warnings, ElementsAre());
}

TEST(Lif, of_others_is_read_for_one_layout_and_one_kind_of_vehicle) {
  ordered_json lif = lif_of(graph(), header);
  ordered_json& layout = lif["layouts"][0];
  layout["edges"][1]["vehicleTypeEdgeProperties"][0]["trajectory"] = {{"knotVector", {0, 0, 1, 1}}};
  layout["edges"][2]["vehicleTypeEdgeProperties"][0]["vehicleTypeId"] = "forklift";
  layout["edges"].push_back(layout["edges"][0]);
  layout["edges"][3]["edgeId"] = "lift";
  layout["edges"][3]["endNodeId"] = "N1 upstairs";
  lif["layouts"].push_back(layout);
  lif["layouts"][1]["layoutId"] = "upstairs";
  EXPECT_THAT(refusal(lif.dump()), HasSubstr("found layouts 'lab', 'upstairs', wanted one"));
  EXPECT_THAT(refusal(lif.dump(), {.layout = "cellar", .vehicle_type = ""}), HasSubstr("wanted 'cellar'"));

  const ImportedLif read = read_lif(lif.dump(), "hall.lif", {.layout = "lab", .vehicle_type = "nurse"});
  EXPECT_THAT(read.warnings, ElementsAre("edge 'desk to door' is a curve, taken as a straight line",
                                         "edge 'door to desk' is not for this vehicle type",
                                         "edge 'lift' leads out of the layout"));
  ASSERT_EQ(read.places.edges.size(), 2U);
  EXPECT_TRUE(read.places.edges[1].one_way);
}

TEST(Lif, is_refused_with_its_name_when_it_is_none_or_cannot_be_kept) {
  EXPECT_THAT(refusal("{"), HasSubstr("hall.lif"));
  EXPECT_THAT(refusal("{}"), HasSubstr("layouts"));
  ordered_json lif = lif_of(graph(), header);
  lif["layouts"][0]["edges"][0]["vehicleTypeEdgeProperties"][0]["maxSpeed"] = 0.0;
  EXPECT_THAT(refusal(lif.dump()), HasSubstr("max_mps"));
  lif = lif_of(graph(), header);
  lif["layouts"][0]["nodes"][2]["nodeId"] = "desk";
  EXPECT_THAT(refusal(lif.dump()), HasSubstr("'desk' twice"));
}

}  // namespace
}  // namespace lodestar
