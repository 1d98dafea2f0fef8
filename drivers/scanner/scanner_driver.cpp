#include "drivers/scanner/scanner_driver.hpp"

#include "maps/input_error.hpp"

namespace lodestar {
namespace {

/// Of one poll: more than the fastest scanner sends in 0.1 s, so that a poll always ends.
constexpr int most_reads = 200;

}  // namespace

ScannerDriver::ScannerDriver(Open open, std::unique_ptr<ScannerProtocol> protocol,
                             ScannerDriverOptions options)
    : open_(std::move(open)),
      protocol_(std::move(protocol)),
      options_(std::move(options)),
      link_(std::make_unique<ByteLink>(open_())),
      heard_(options_.now()) {
  protocol_->connect(heard_);
}

ScannerDriver::~ScannerDriver() {
  if (link_) link_->send(protocol_->farewell());
}

std::optional<Scan> ScannerDriver::poll() {
  take_opened();
  if (link_) read();
  std::optional<Scan> scan = protocol_->next();
  const Stamp now = options_.now();
  if (scan) heard_ = now;
  const bool is_gone = !link_ || link_->is_lost();
  const Duration patience = is_gone ? options_.retry_period : options_.max_silence;
  if (!scan && !opening_.valid() && now - heard_ >= patience) open_again();
  return scan;
}

ScanPackets ScannerDriver::packets() const {
  const ProtocolCounts counts = protocol_->counts();
  return {.read = counts.frames, .refused = counts.checksum_errors};
}

void ScannerDriver::read() {
  for (int i = 0; i < most_reads; ++i) {
    const ByteView bytes = link_->receive();
    if (bytes.empty()) break;
    protocol_->take(bytes, options_.now());
  }
  link_->send(protocol_->step(options_.now()));
}

/// Closes the old device first: while its node is open, the scanner that comes back gets another name.
void ScannerDriver::open_again() {
  heard_ = options_.now();
  link_.reset();
  opening_ = std::async(std::launch::async, [open = open_] {
    try {
      return std::make_unique<ByteLink>(open());
    } catch (const InputError&) {
      return std::unique_ptr<ByteLink>();  // not yet
    }
  });
}

void ScannerDriver::take_opened() {
  if (!opening_.valid() || opening_.wait_for(Duration::zero()) != std::future_status::ready) return;
  link_ = opening_.get();
  heard_ = options_.now();
  if (link_) protocol_->connect(heard_);
}

}  // namespace lodestar
