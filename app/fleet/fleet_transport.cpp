#include "app/fleet/fleet_transport.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <fmt/format.h>
#include <fstream>
#include <mosquitto.h>

#include "app/fleet/message_reader.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

using SteadyTime = std::chrono::steady_clock::time_point;

std::int64_t unix_ms() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::milliseconds>(now).count();
}

std::string first_line(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line;
  if (!std::getline(stream, line)) throw InputError(file, 0, "nothing", "the password at the broker");
  return line;
}

const char* or_null(const std::string& text) {
  return text.empty() ? nullptr : text.c_str();
}

}  // namespace

class FleetTransport::Client {
  /// libmosquitto's own state, once in the process.
  struct Library {
    Library() { mosquitto_lib_init(); }
    ~Library() { mosquitto_lib_cleanup(); }
    Library(const Library&) = delete;
    Library& operator=(const Library&) = delete;
  };

  struct EndClient {
    void operator()(mosquitto* client) const { mosquitto_destroy(client); }
  };

 public:
  Client(const FleetSettings& settings, Factsheet factsheet, FleetLink& link,
         std::function<void(Severity, const std::string&)> tell)
      : settings_(settings),
        address_(broker_address(settings.broker)),
        version_(vda_version(settings.version).value()),
        factsheet_(std::move(factsheet)),
        link_(link),
        tell_(std::move(tell)) {
    const std::string id = fmt::format("lodestar-{}-{}", settings.manufacturer, settings.serial);
    mosquitto_.reset(mosquitto_new(id.c_str(), true, this));
    if (!mosquitto_) throw InputError("fleet: found no memory for a client, wanted it");
    mosquitto_connect_callback_set(mosquitto_.get(), [](mosquitto*, void* self, int result) {
      static_cast<Client*>(self)->has_connected(result);
    });
    mosquitto_disconnect_callback_set(mosquitto_.get(), [](mosquitto*, void* self, int result) {
      static_cast<Client*>(self)->has_disconnected(result);
    });
    mosquitto_message_callback_set(mosquitto_.get(),
                                   [](mosquitto*, void* self, const mosquitto_message* message) {
                                     static_cast<Client*>(self)->has_received(*message);
                                   });
    mosquitto_log_callback_set(mosquitto_.get(), [](mosquitto*, void* self, int level, const char* words) {
      if (level == MOSQ_LOG_ERR) static_cast<Client*>(self)->log_ = words;
    });
    identify();
  }

  void run(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      if (state_ == State::away && Clock::now() >= next_try_) connect();
      turn();
      if (state_ == State::online) send();
    }
    say_goodbye();
  }

 private:
  using Clock = std::chrono::steady_clock;
  enum class State { away, connecting, online };

  void identify() {
    if (!settings_.user.empty()) {
      const std::string password = settings_.password_file.empty() ? "" : first_line(settings_.password_file);
      check(mosquitto_username_pw_set(mosquitto_.get(), settings_.user.c_str(), or_null(password)), "user");
    }
    if (!address_.has_tls) return;
    constexpr const char* system_certificates = "/etc/ssl/certs";
    const std::string ca = settings_.ca_file.string();
    check(mosquitto_tls_set(mosquitto_.get(), or_null(ca), ca.empty() ? system_certificates : nullptr,
                            or_null(settings_.certificate_file.string()),
                            or_null(settings_.key_file.string()), nullptr),
          "certificates");
  }

  static void check(int result, const char* what) {
    if (result == MOSQ_ERR_SUCCESS) return;
    throw InputError(fmt::format("fleet: found no usable {} ({}), wanted those of site.yaml", what,
                                 mosquitto_strerror(result)));
  }

  [[nodiscard]] std::string topic(const char* name) const {
    return fmt::format("{}/v2/{}/{}/{}", settings_.interface, settings_.manufacturer, settings_.serial, name);
  }

  MessageHeader header(std::uint32_t& counter) const {
    return {.version = version_,
            .number = counter++,
            .timestamp = timestamp_text(unix_ms()),
            .manufacturer = settings_.manufacturer,
            .serial = settings_.serial};
  }

  void connect() {
    constexpr int keepalive_s = 10;  // a broker calls a connection broken after 1.5 times that
    const std::string will = connection_text(header(connection_count_), ConnectionState::broken);
    mosquitto_will_set(mosquitto_.get(), topic("connection").c_str(), static_cast<int>(will.size()),
                       will.data(), 1, true);
    const int result =
        mosquitto_connect_async(mosquitto_.get(), address_.host.c_str(), address_.port, keepalive_s);
    if (result != MOSQ_ERR_SUCCESS) return wait_for_broker(words_of(result));
    state_ = State::connecting;
    give_up_ = Clock::now() + std::chrono::seconds(10);
  }

  static std::string words_of(int result) {
    return result == MOSQ_ERR_ERRNO ? std::string(std::strerror(errno)) : mosquitto_strerror(result);
  }

  /// One turn of the library: what has come in, what waits to go out. Takes 20 ms where nothing happens.
  void turn() {
    constexpr int patience_ms = 20;
    if (state_ == State::away) {
      std::this_thread::sleep_for(std::chrono::milliseconds(patience_ms));
      return;
    }
    const int result = mosquitto_loop(mosquitto_.get(), patience_ms, 1);
    if (state_ == State::away) return;  // a callback said so
    if (result != MOSQ_ERR_SUCCESS) return wait_for_broker(words_of(result));
    if (state_ == State::connecting && Clock::now() > give_up_) {
      mosquitto_disconnect(mosquitto_.get());
      wait_for_broker("no answer");
    }
  }

  /// What OpenSSL said of the last connection, such as "certificate verify failed"; empty for nothing.
  [[nodiscard]] std::string words_of_openssl() const {
    const std::size_t reason = log_.rfind("::");
    return reason == std::string::npos ? "" : fmt::format(" ({})", log_.substr(reason + 2));
  }

  void wait_for_broker(const std::string& result) {
    constexpr Clock::duration longest = std::chrono::seconds(5);
    const std::string why = result + words_of_openssl();
    log_.clear();
    if (said_ != why)
      tell_(Severity::warning, fmt::format("fleet: no connection to {}: {}", settings_.broker, why));
    said_ = why;
    state_ = State::away;
    next_try_ = Clock::now() + pause_;
    pause_ = std::min<Clock::duration>(2 * pause_, longest);
  }

  void has_connected(int result) {
    if (result != 0) return wait_for_broker(mosquitto_connack_string(result));
    for (const char* name : {"order", "instantActions"})
      mosquitto_subscribe(mosquitto_.get(), nullptr, topic(name).c_str(), 0);
    state_ = State::online;
    pause_ = first_pause;
    said_.clear();
    publish("connection", connection_text(header(connection_count_), ConnectionState::online), 1, true);
    publish("factsheet", factsheet_text(header(factsheet_count_), factsheet_), 0, true);
    link_.connected();
    tell_(Severity::info, fmt::format("fleet: connected to {} as {}/{}", settings_.broker,
                                      settings_.manufacturer, settings_.serial));
  }

  void has_disconnected(int result) {
    if (result != 0 && state_ != State::away) wait_for_broker(words_of(result));
  }

  /// A retained order is of another day: nobody may find the robot driving off by it.
  void has_received(const mosquitto_message& message) {
    if (message.retain)
      return tell_(Severity::warning, fmt::format("fleet: {} is retained: ignored", message.topic));
    const std::string_view text(static_cast<const char*>(message.payload),
                                static_cast<std::size_t>(message.payloadlen));
    const MessageAddress address{.manufacturer = settings_.manufacturer, .serial = settings_.serial};
    const bool is_order = message.topic == topic("order");
    if (!link_.give(is_order ? read_order(text, address) : read_instant_actions(text, address)))
      tell_(Severity::warning, "fleet: too many messages at once: one is ignored");
  }

  void send() {
    if (mosquitto_want_write(mosquitto_.get())) return;  // the last one is still on its way
    if (link_.take_factsheet_wish())
      publish("factsheet", factsheet_text(header(factsheet_count_), factsheet_), 0, true);
    if (const std::optional<FleetReport> report = link_.newest())
      publish("state", state_text(header(state_count_), *report), 0, false);
  }

  void publish(const char* name, const std::string& text, int quality, bool is_retained) {
    mosquitto_publish(mosquitto_.get(), nullptr, topic(name).c_str(), static_cast<int>(text.size()),
                      text.data(), quality, is_retained);
  }

  void say_goodbye() {
    if (state_ != State::online) return;
    send();
    publish("connection", connection_text(header(connection_count_), ConnectionState::offline), 1, true);
    const SteadyTime until = Clock::now() + std::chrono::seconds(1);
    while (mosquitto_want_write(mosquitto_.get()) && Clock::now() < until)
      if (mosquitto_loop(mosquitto_.get(), 20, 1) != MOSQ_ERR_SUCCESS) return;
    mosquitto_loop(mosquitto_.get(), 20, 1);
    mosquitto_disconnect(mosquitto_.get());
    mosquitto_loop(mosquitto_.get(), 20, 1);
  }

  static constexpr Clock::duration first_pause = std::chrono::milliseconds(500);

  Library library_;
  FleetSettings settings_;
  BrokerAddress address_;
  VdaVersion version_;
  Factsheet factsheet_;
  FleetLink& link_;
  std::function<void(Severity, const std::string&)> tell_;
  std::unique_ptr<mosquitto, EndClient> mosquitto_;
  State state_ = State::away;
  SteadyTime next_try_;
  SteadyTime give_up_;
  Clock::duration pause_ = first_pause;
  std::string said_;
  std::string log_;  ///< the library's newest error
  std::uint32_t connection_count_ = 0;
  std::uint32_t state_count_ = 0;
  std::uint32_t factsheet_count_ = 0;
};

FleetTransport::FleetTransport(const FleetSettings& settings, const Factsheet& factsheet, FleetLink& link,
                               std::function<void(Severity, const std::string&)> tell)
    : client_(std::make_unique<Client>(settings, factsheet, link, std::move(tell))),
      thread_([this](const std::stop_token& stop) { client_->run(stop); }) {}

FleetTransport::~FleetTransport() = default;

}  // namespace lodestar
