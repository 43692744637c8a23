#pragma once
#include <string>
#include <utility>
#include <vector>

#include "core/toml.h"

namespace faba {

/// A variant of a part of a scenario, as listed in a study:
///
///     [[model]]
///     name = "slow"                       # its type when absent
///     type = "dipole"                     # with its parameters, as in the scenario
///     speed = "100 um/s"
///     set = { "swarm[0].count" = 200 }    # further values of the scenario to override
struct Variant {
  std::string name = {};
  Json part = {};                                      ///< table with `type`; null: that of the scenario
  std::vector<std::pair<std::string, Json>> set = {};  ///< path and value
  std::string origin = {};                             ///< "study.toml:12: model[0]", for messages
  Json extra = Json::object();                         ///< keys that the caller reads
};

/// The tables [[key]] of a study; `extra` are further permitted keys. When there are none, one variant that
/// leaves the scenario unchanged. Throws Error(usage) for tables of another form and for duplicate names.
std::vector<Variant> read_variants(const Node& study, const std::string& key,
                                   const std::vector<std::string>& extra = {});

/// JSON Schema of one of these tables, without the keys of the part itself and without `extra`.
Json variant_schema(const std::string& description);

/// Sets `place` of the scenario ("controller") to the part of a variant, or with "model" the model of every
/// swarm, and then the other values.
void apply(const Variant& variant, const std::string& place, Document& scenario);

}  // namespace faba
