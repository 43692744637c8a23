#include "sim/state.h"

#include <algorithm>

#include "core/hash.h"

namespace faba {

Columns::Columns(std::size_t agents) : size_(agents) {
  for (const char* name : {"x", "y", "response"}) add(name);
}

void Columns::add(std::string_view name) {
  if (!has(name)) columns_.push_back({std::string(name), std::vector<float>(size_, 0.0f)});
}

bool Columns::has(std::string_view name) const {
  return std::any_of(columns_.begin(), columns_.end(), [&](const Column& c) { return c.name == name; });
}

std::span<float> Columns::operator[](std::string_view name) {
  for (Column& c : columns_)
    if (c.name == name) return c.data;
  throw Error(Errc::internal, std::string(name), "no such column");
}

std::span<const float> Columns::operator[](std::string_view name) const {
  return const_cast<Columns&>(*this)[name];  // does not modify
}

void Columns::assign(const Columns& other) {
  const auto same = [](const Column& a, const Column& b) {
    return a.name == b.name && a.data.size() == b.data.size();
  };
  if (!std::equal(columns_.begin(), columns_.end(), other.columns_.begin(), other.columns_.end(), same))
    throw Error(Errc::input, "checkpoint", "belongs to another scenario");
  for (std::size_t i = 0; i < columns_.size(); ++i)
    std::copy(other.columns_[i].data.begin(), other.columns_[i].data.end(), columns_[i].data.begin());
}

void State::assign(const State& other) {
  agents.assign(other.agents);
  step = other.step;
  t = other.t;
  current = other.current;
  command = other.command;
}

std::string State::hash() const {
  std::vector<const Column*> sorted;  // sorted, so that the order of declaration does not matter
  for (const Column& c : agents.all()) sorted.push_back(&c);
  std::sort(sorted.begin(), sorted.end(), [](auto* a, auto* b) { return a->name < b->name; });
  Hash h;
  h.value(step);
  for (const Column* c : sorted) {
    h.text(c->name);
    h.values(std::span<const float>(c->data));
  }
  h.values(std::span<const double>(current));
  h.values(std::span<const double>(command));
  return h.hex();
}

}  // namespace faba
