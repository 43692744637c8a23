#pragma once
#include <string>
#include <utility>
#include <vector>

#include "core/toml.h"

namespace faba {

/// One of several ways to fill a place of a scenario, as a study lists them:
///
///     [[model]]
///     name = "slow"                       # its type when absent
///     type = "dipole"                     # with its parameters: what stands in the scenario at that place
///     speed = "100 um/s"
///     set = { "swarm[0].count" = 200 }    # other values of the scenario that go with it
struct Variant {
  std::string name = {};
  Json part = {};                                      ///< table with `type`; null: the scenario's own
  std::vector<std::pair<std::string, Json>> set = {};  ///< path and value
  std::string origin = {};                             ///< "study.toml:12: model[0]", for messages
  Json extra = Json::object();                         ///< the keys that the caller reads himself
};

/// The tables [[key]] of a study; `extra` are further keys that they may have. One that stands for the
/// scenario as it is when there are none. Throws Error(usage) for tables of another form, and names that are
/// used twice.
std::vector<Variant> read_variants(const Node& study, const std::string& key,
                                   const std::vector<std::string>& extra = {});

/// JSON Schema of one of these tables, without the keys of the part itself and without `extra`.
Json variant_schema(const std::string& description);

/// Puts a variant's part at `place` ("controller"), or as the model of every swarm ("model"), and then its
/// other values.
void apply(const Variant& variant, const std::string& place, Document& scenario);

}  // namespace faba
