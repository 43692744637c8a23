#pragma once
#include <memory>
#include <string>

#include "app/scenario/parts.h"
#include "core/toml.h"

namespace faba {

/// A coil or coil system from TOML.
inline std::unique_ptr<Field> field_of(const std::string& toml) {
  const Document d = parse_toml(toml, "test");
  return engine_parts().field.resolve(Node(d)).make({});
}

}  // namespace faba
