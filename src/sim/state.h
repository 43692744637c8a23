#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/archive.h"

namespace faba {

/// One quantity of every agent.
struct Column {
  std::string name;
  std::vector<float> data;
  void archive(Archive& a) { a& name& data; }
};

/// What agents remember, one column per quantity. `x` and `y` (m, world frame) and `response` (+1
/// north-seeking, -1 south-seeking, 0 no longer responding to the field) are always there; models and
/// motility laws declare the rest.
class Columns {
 public:
  Columns() : Columns(0) {}
  explicit Columns(std::size_t agents);
  std::size_t size() const { return size_; }
  /// Adds a column of zeros unless it is there already.
  void add(std::string_view name);
  bool has(std::string_view name) const;
  /// Throws Error(internal) when nobody declared it.
  std::span<float> operator[](std::string_view name);
  std::span<const float> operator[](std::string_view name) const;
  const std::vector<Column>& all() const { return columns_; }
  void archive(Archive& a) { a& size_& columns_; }

 private:
  std::size_t size_;
  std::vector<Column> columns_;
};

/// All that changes during a run. Copy it and you have a snapshot.
struct State {
  std::uint64_t step = 0;
  double t = 0;  ///< s
  Columns agents;
  std::vector<double> current;  ///< flowing in each coil, A
  std::vector<double> command;  ///< asked of each coil, A; `current` follows it with the coil's lag

  /// Hash of everything above, as sixteen hexadecimal digits; equal states have equal hashes on every
  /// machine.
  std::string hash() const;
  void archive(Archive& a) { a& step& t& agents& current& command; }
};

}  // namespace faba
