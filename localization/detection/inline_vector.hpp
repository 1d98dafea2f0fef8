#pragma once

#include <boost/container/static_vector.hpp>
#include <cstddef>
#include <ranges>
#include <span>

namespace lodestar {

/// Up to `most` values stored inline, without allocation: a marker's counts are known to be small.
template <typename Value, std::size_t most>
class InlineVector : public boost::container::static_vector<Value, most> {
  using Base = boost::container::static_vector<Value, most>;

 public:
  using Base::Base;

  /// Boost 1.74 does not declare its iterators contiguous, which a span asks for.
  operator std::span<const Value>() const  // NOLINT(google-explicit-constructor): as other ranges convert
    requires(!std::ranges::contiguous_range<Base>)
  {
    return {this->data(), this->size()};
  }
};

}  // namespace lodestar
