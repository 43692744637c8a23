#pragma once
#include <doctest/doctest.h>
#include <fmt/ranges.h>

#include <string>
#include <vector>

#include "app/scenario/parts.h"

namespace faba::contract {

/// What is wrong with a part, a sentence each. The tests of this folder expect none of every part of the
/// program, and some of parts that are wrong on purpose.
using Findings = std::vector<std::string>;

inline const Parts& parts() {
  static const Parts all = builtin_parts();
  return all;
}

/// A part from its table, as a scenario gives it, or from its name alone. Throws Error(usage).
template <class R>
typename R::PartType resolved(const R& registry, const Json& table) {
  Document d;
  d.root = Json{{"part", table}};
  return registry.resolve(Node(d).child("part"));
}

}  // namespace faba::contract

#define CHECK_NOTHING_WRONG(findings)                                          \
  do {                                                                         \
    const faba::contract::Findings found_ = findings;                          \
    CHECK_MESSAGE(found_.empty(), fmt::format("{}", fmt::join(found_, "\n"))); \
  } while (false)
