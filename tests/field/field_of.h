#pragma once
#include <memory>
#include <string>

#include "core/toml.h"
#include "field/coils/coils.h"

namespace faba {

/// A coil or a rig from TOML.
inline std::unique_ptr<Field> field_of(const std::string& toml) {
  FieldRegistry r{"field", ""};
  add_coils(r);
  add_rig(r);
  const Document d = parse_toml(toml, "test");
  return r.resolve(Node(d)).make({});
}

}  // namespace faba
