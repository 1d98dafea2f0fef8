#include "app/ros2/dds_node.hpp"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <ros2_messages.h>

#include "maps/input_error.hpp"

namespace lodestar {
namespace {

struct EndQos {
  void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
};
using Qos = std::unique_ptr<dds_qos_t, EndQos>;

Qos qos_of(const TopicQos& wanted) {
  Qos qos(dds_create_qos());
  // A writer gives up at once on a reader that does not keep up, so that it delays no other topic.
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, 0);
  dds_qset_durability(qos.get(),
                      wanted.keeps_for_late ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, wanted.depth);
  return qos;
}

void set_user_data(const Qos& qos, const std::string& text) {
  dds_qset_userdata(qos.get(), text.data(), text.size());
}

/// The library's configuration; a user's own, in CYCLONEDDS_URI, takes its place. The loopback interface has
/// no multicast: there, participants are looked for at their ports.
std::string configuration(const std::string& interface) {
  if (std::getenv("CYCLONEDDS_URI") != nullptr) return {};
  std::string settings;
  if (!interface.empty())
    settings = fmt::format(R"(<General><Interfaces><NetworkInterface name="{}"/></Interfaces></General>)",
                           interface);
  if (interface == "lo")
    settings +=
        "<Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>32</"
        "MaxAutoParticipantIndex>"
        R"(<Peers><Peer address="127.0.0.1"/></Peers></Discovery>)";
  // What it would print goes nowhere: what matters is told by results.
  settings += "<Tracing><Verbosity>none</Verbosity></Tracing>";
  return R"(<CycloneDDS><Domain Id="any">)" + settings + "</Domain></CycloneDDS>";
}

/// What the library said last of what it could not do.
std::string& said_by_library() {
  static std::string said;
  return said;
}

void listen_to_library(void* /*unused*/, const dds_log_data_t* words) {
  std::string said(words->message, words->size);
  while (!said.empty() && std::isspace(static_cast<unsigned char>(said.back())) != 0) said.pop_back();
  said_by_library() = std::move(said);
}

dds_entity_t checked(dds_entity_t made, const std::string& what) {
  if (made >= 0) return made;
  const std::string why = said_by_library().empty() ? dds_strretcode(-made) : said_by_library();
  throw InputError(fmt::format("ros2: found no {} ({}), wanted one", what, why));
}

template <typename Gid>
Gid gid_of(dds_entity_t entity) {
  dds_guid_t guid{};
  (void)dds_get_guid(entity, &guid);
  Gid gid{};
  static_assert(sizeof gid.data >= sizeof guid.v);
  std::memcpy(gid.data, guid.v, sizeof guid.v);
  return gid;
}

/// The message of rmw_dds_common, whose types differ from distribution to distribution.
template <typename Info, typename NodeInfo, typename Gid>
void write_entities(dds_entity_t writer, dds_entity_t participant, const std::string& name,
                    const std::vector<dds_entity_t>& readers, const std::vector<dds_entity_t>& writers) {
  const auto gids = [](const std::vector<dds_entity_t>& entities) {
    std::vector<Gid> found;
    std::ranges::transform(entities, std::back_inserter(found), gid_of<Gid>);
    return found;
  };
  std::vector<Gid> reading = gids(readers);
  std::vector<Gid> writing = gids(writers);
  NodeInfo node{};
  node.node_namespace[0] = '/';
  name.copy(node.node_name, sizeof node.node_name - 1);
  const auto lend = [](auto& sequence, auto* first, std::size_t count) {
    sequence._buffer = first;
    sequence._length = sequence._maximum = static_cast<std::uint32_t>(count);
  };
  lend(node.reader_gid_seq, reading.data(), reading.size());
  lend(node.writer_gid_seq, writing.data(), writing.size());
  Info info{};
  info.gid = gid_of<Gid>(participant);
  lend(info.node_entities_info_seq, &node, 1);
  (void)dds_write(writer, &info);
}

}  // namespace

DdsNode::DdsNode(const std::string& name, const Ros2Options& options) : name_(name), distro_(options.distro) {
  const auto domain = static_cast<dds_domainid_t>(options.domain);
  const std::string config = configuration(options.interface);
  dds_set_log_sink(listen_to_library, nullptr);
  const std::string network =
      options.interface.empty() ? "usable network" : "network interface " + options.interface;
  if (!config.empty()) domain_ = checked(dds_create_domain(domain, config.c_str()), network);
  const Qos qos(dds_create_qos());
  set_user_data(qos, "enclave=/;");
  participant_ = dds_create_participant(domain, qos.get(), nullptr);
  if (participant_ < 0) {
    if (domain_ > 0) (void)dds_delete(domain_);
    (void)checked(participant_,
                  options.interface.empty() ? "usable network" : ("interface " + options.interface).c_str());
  }
  // Humble's and later nodes call the type the same; the fields differ.
  dds_topic_descriptor_t type = distro_ == RosDistro::humble
                                    ? humble_msg_dds__ParticipantEntitiesInfo__desc
                                    : rmw_dds_common_msg_dds__ParticipantEntitiesInfo__desc;
  type.m_typename = rmw_dds_common_msg_dds__ParticipantEntitiesInfo__desc.m_typename;
  const Qos kept = qos_of({.keeps_for_late = true, .depth = 1});
  set_user_data(kept, "typehash=RIHS01_91a0593bacdcc50ea9bdcf849a938b128412cc1ea821245c663bcd26f83c295e;");
  discovery_ = checked(
      dds_create_writer(participant_, make_topic("ros_discovery_info", type), kept.get(), nullptr), "writer");
}

DdsNode::~DdsNode() {
  (void)dds_delete(participant_);
  if (domain_ > 0) (void)dds_delete(domain_);
}

dds_entity_t DdsNode::make_topic(const char* name, const dds_topic_descriptor_t& type) const {
  return checked(dds_create_topic(participant_, &type, name, nullptr, nullptr), name);
}

int DdsNode::open(const RosTopic& topic) {
  const Qos qos = qos_of(topic.qos);
  set_user_data(qos, fmt::format("typehash={};", topic.type_hash));
  const dds_entity_t made = make_topic(("rt/" + std::string(topic.name)).c_str(), *topic.type);
  writers_.push_back(checked(dds_create_writer(participant_, made, qos.get(), nullptr), topic.name));
  return writers_.back();
}

dds_entity_t DdsNode::make_reader(const RosTopic& topic) {
  const Qos qos = qos_of(topic.qos);
  set_user_data(qos, fmt::format("typehash={};", topic.type_hash));
  const dds_entity_t made = make_topic(("rt/" + std::string(topic.name)).c_str(), *topic.type);
  readers_.push_back(checked(dds_create_reader(participant_, made, qos.get(), nullptr), topic.name));
  return readers_.back();
}

void DdsNode::announce() {
  if (distro_ == RosDistro::humble) {
    write_entities<humble_msg_dds__ParticipantEntitiesInfo_, humble_msg_dds__NodeEntitiesInfo_,
                   humble_msg_dds__Gid_>(discovery_, participant_, name_, readers_, writers_);
  } else {
    write_entities<rmw_dds_common_msg_dds__ParticipantEntitiesInfo_,
                   rmw_dds_common_msg_dds__NodeEntitiesInfo_, rmw_dds_common_msg_dds__Gid_>(
        discovery_, participant_, name_, readers_, writers_);
  }
}

void DdsNode::write(int topic, const void* message, Stamp /*stamp*/) {
  (void)dds_write(topic, message);
}

}  // namespace lodestar
