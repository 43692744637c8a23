#pragma once
#include <doctest/doctest.h>
#include <fmt/ranges.h>

#include <string>
#include <vector>

#include "app/scenario/parts.h"

namespace faba::contract {

/// Violations of the contract of a part, one sentence each. The tests of this folder expect none for every
/// part of the program, and some for deliberately faulty parts.
using Findings = std::vector<std::string>;

inline const Parts& parts() {
  static const Parts all = builtin_parts();
  return all;
}

/// A part from its table, as in a scenario, or from its name. Throws Error(usage).
template <class R>
typename R::PartType resolved(const R& registry, const Json& table) {
  Document d;
  d.root = Json{{"part", table}};
  return registry.resolve(Node(d).child("part"));
}

}  // namespace faba::contract

#define CHECK_NO_FINDINGS(findings)                                            \
  do {                                                                         \
    const faba::contract::Findings found_ = findings;                          \
    CHECK_MESSAGE(found_.empty(), fmt::format("{}", fmt::join(found_, "\n"))); \
  } while (false)
