#pragma once

#include <boost/beast/core/tcp_stream.hpp>
#include <list>

namespace lodestar {

/// The connections whose client has yet to send a request, or the rest of one.
class WaitingConnections {
 public:
  /// Ends the one that has waited longest; false when none waits.
  bool end_longest() {
    if (streams_.empty()) return false;
    streams_.front()->close();
    streams_.pop_front();
    return true;
  }

  /// One of them for as long as this lives, or until it was ended.
  class Entry {
   public:
    Entry(WaitingConnections& all, boost::beast::tcp_stream& stream) : all_(all), stream_(stream) {
      all_.streams_.push_back(&stream_);
    }
    ~Entry() { all_.streams_.remove(&stream_); }
    Entry(const Entry&) = delete;
    Entry& operator=(const Entry&) = delete;

   private:
    WaitingConnections& all_;
    boost::beast::tcp_stream& stream_;
  };

 private:
  std::list<boost::beast::tcp_stream*> streams_;
};

}  // namespace lodestar
