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

/// State of the agents, one column per quantity. `x` and `y` (m, world frame) and `response` (+1
/// north-seeking, -1 south-seeking, 0 not responding to the field) always exist; models and motility laws
/// declare the others.
class Columns {
 public:
  Columns() : Columns(0) {}
  explicit Columns(std::size_t agents);
  std::size_t size() const { return size_; }
  /// Adds a column of zeros unless it exists.
  void add(std::string_view name);
  bool has(std::string_view name) const;
  /// Throws Error(internal) if the column does not exist.
  std::span<float> operator[](std::string_view name);
  std::span<const float> operator[](std::string_view name) const;
  const std::vector<Column>& all() const { return columns_; }
  /// Copies the values of equal columns; views of the columns stay valid. Throws Error(input) if the columns
  /// differ.
  void assign(const Columns& other);
  void archive(Archive& a) { a& size_& columns_; }

 private:
  std::size_t size_;
  std::vector<Column> columns_;
};

/// Everything that changes during a run; a copy is a snapshot.
struct State {
  std::uint64_t step = 0;
  double t = 0;  ///< s
  Columns agents;
  std::vector<double> current;  ///< current in each coil, A
  std::vector<double>
      command;  ///< commanded current of each coil, A; `current` follows with the lag of the coil

  /// State hash, sixteen hexadecimal digits; equal on all machines for equal states.
  std::string hash() const;
  /// Copies a state with equal columns; views of the columns stay valid. Throws Error(input) if they differ.
  void assign(const State& other);
  void archive(Archive& a) { a& step& t& agents& current& command; }
};

}  // namespace faba
