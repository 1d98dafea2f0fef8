// A participant of another vendor (eProsima Fast DDS), told by lines on standard input:
//
//   read TOPIC TYPE kept|passing [unread]     subscribe; kept: transient local; unread: takes nothing
//   write TOPIC TYPE HEX                      publish these bytes, header of the CDR included
//
// Only over the loopback interface. It prints a line of JSON for each message (`topic`, `hex`), and for each
// writer that it discovers (`writer`, `type`, `reliable`, `kept`, `user_data`). Ends with its input.
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <iostream>
#include <map>
#include <memory>
#include <mutex>
#include <sstream>
#include <string>
#include <vector>

using namespace eprosima::fastdds::dds;
using eprosima::fastrtps::rtps::InstanceHandle_t;
using eprosima::fastrtps::rtps::SerializedPayload_t;

namespace {

using Bytes = std::vector<unsigned char>;

std::mutex printing;

void print(const std::string& line) {
  const std::lock_guard lock(printing);
  std::cout << line << std::endl;
}

std::string hex(const Bytes& bytes) {
  constexpr const char* digits = "0123456789abcdef";
  std::string text;
  for (const unsigned char byte : bytes) {
    text += digits[byte >> 4U];
    text += digits[byte & 15U];
  }
  return text;
}

Bytes bytes_of(const std::string& text) {
  Bytes bytes;
  for (std::size_t i = 0; i + 1 < text.size(); i += 2)
    bytes.push_back(static_cast<unsigned char>(std::stoi(text.substr(i, 2), nullptr, 16)));
  return bytes;
}

/// Any type, as the bytes that are on the wire.
class RawType : public TopicDataType {
 public:
  explicit RawType(const std::string& name) {
    setName(name.c_str());
    m_typeSize = 1024;
    m_isGetKeyDefined = false;
  }
  bool serialize(void* data, SerializedPayload_t* payload) override {
    const Bytes& bytes = *static_cast<Bytes*>(data);
    payload->reserve(static_cast<std::uint32_t>(bytes.size()));
    std::copy(bytes.begin(), bytes.end(), payload->data);
    payload->length = static_cast<std::uint32_t>(bytes.size());
    return true;
  }
  bool deserialize(SerializedPayload_t* payload, void* data) override {
    static_cast<Bytes*>(data)->assign(payload->data, payload->data + payload->length);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return static_cast<std::uint32_t>(static_cast<Bytes*>(data)->size()); };
  }
  void* createData() override { return new Bytes; }
  void deleteData(void* data) override { delete static_cast<Bytes*>(data); }
  bool getKey(void*, InstanceHandle_t*, bool) override { return false; }
};

class Discovery : public DomainParticipantListener {
  void on_publisher_discovery(DomainParticipant*,
                              eprosima::fastrtps::rtps::WriterDiscoveryInfo&& found) override {
    if (found.status != eprosima::fastrtps::rtps::WriterDiscoveryInfo::DISCOVERED_WRITER) return;
    const auto& qos = found.info.m_qos;
    const auto& user = qos.m_userData;
    std::ostringstream line;
    line << R"({"writer":")" << found.info.topicName() << R"(","type":")" << found.info.typeName()
         << R"(","reliable":)" << (qos.m_reliability.kind == RELIABLE_RELIABILITY_QOS ? "true" : "false")
         << R"(,"kept":)" << (qos.m_durability.kind == TRANSIENT_LOCAL_DURABILITY_QOS ? "true" : "false")
         << R"(,"user_data":")" << std::string(user.begin(), user.end()) << "\"}";
    print(line.str());
  }
};

class Printer : public DataReaderListener {
 public:
  explicit Printer(std::string topic) : topic_(std::move(topic)) {}
  void on_data_available(DataReader* reader) override {
    Bytes bytes;
    SampleInfo info;
    while (reader->take_next_sample(&bytes, &info) == ReturnCode_t::RETCODE_OK)
      if (info.valid_data) print(R"({"topic":")" + topic_ + R"(","hex":")" + hex(bytes) + "\"}");
  }

 private:
  std::string topic_;
};

DomainParticipantQos on_loopback() {
  DomainParticipantQos qos = PARTICIPANT_QOS_DEFAULT;
  const auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList.emplace_back("127.0.0.1");
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(udp);
  eprosima::fastrtps::rtps::Locator_t host;
  eprosima::fastrtps::rtps::IPLocator::setIPv4(host, 127, 0, 0, 1);
  qos.wire_protocol().builtin.initialPeersList.push_back(host);
  return qos;
}

class Peer {
 public:
  explicit Peer(std::uint32_t domain)
      : participant_(DomainParticipantFactory::get_instance()->create_participant(
            domain, on_loopback(), &discovery_, StatusMask::none())),
        publisher_(participant_->create_publisher(PUBLISHER_QOS_DEFAULT)),
        subscriber_(participant_->create_subscriber(SUBSCRIBER_QOS_DEFAULT)) {}

  void read(const std::string& name, const std::string& type, bool is_kept, bool is_read) {
    DataReaderQos qos = DATAREADER_QOS_DEFAULT;
    qos.reliability().kind = RELIABLE_RELIABILITY_QOS;
    qos.durability().kind = is_kept ? TRANSIENT_LOCAL_DURABILITY_QOS : VOLATILE_DURABILITY_QOS;
    qos.history().depth = 100;
    qos.endpoint().history_memory_policy = eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    printers_.push_back(std::make_unique<Printer>(name));
    subscriber_->create_datareader(topic(name, type), qos, is_read ? printers_.back().get() : nullptr);
  }

  void write(const std::string& name, const std::string& type, Bytes bytes) {
    DataWriter*& writer = writers_[name];
    if (writer == nullptr) {
      DataWriterQos qos = DATAWRITER_QOS_DEFAULT;
      qos.reliability().kind = RELIABLE_RELIABILITY_QOS;
      qos.endpoint().history_memory_policy = eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
      writer = publisher_->create_datawriter(topic(name, type), qos);
      await_reader(*writer);
    }
    writer->write(&bytes);
  }

 private:
  /// Until somebody listens, and has had time to know this writer too: what comes before that is lost.
  static void await_reader(DataWriter& writer) {
    PublicationMatchedStatus matched;
    for (int tries = 0; tries < 1000 && matched.current_count == 0; ++tries) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      writer.get_publication_matched_status(matched);
    }
    std::this_thread::sleep_for(std::chrono::seconds(1));
  }

  Topic* topic(const std::string& name, const std::string& type) {
    if (topics_.count(name) == 0) {
      const TypeSupport raw(new RawType(type));
      raw.register_type(participant_);
      topics_[name] = participant_->create_topic(name, type, TOPIC_QOS_DEFAULT);
    }
    return topics_[name];
  }

  Discovery discovery_;
  DomainParticipant* participant_;
  Publisher* publisher_;
  Subscriber* subscriber_;
  std::map<std::string, Topic*> topics_;
  std::map<std::string, DataWriter*> writers_;
  std::vector<std::unique_ptr<Printer>> printers_;
};

}  // namespace

int main(int count, char** arguments) {
  Peer peer(count > 1 ? static_cast<std::uint32_t>(std::stoul(arguments[1])) : 0);
  std::string line;
  while (std::getline(std::cin, line)) {
    std::istringstream words(line);
    std::string verb, topic, type, third, fourth;
    words >> verb >> topic >> type >> third >> fourth;
    if (verb == "read") peer.read(topic, type, third == "kept", fourth != "unread");
    if (verb == "write") peer.write(topic, type, bytes_of(third));
  }
  std::_Exit(0);  // what the library still does in its threads is of no interest
}
