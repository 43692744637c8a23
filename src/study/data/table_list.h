#pragma once
#include <fmt/format.h>

#include <string>
#include <vector>

#include "core/schema.h"

namespace faba {

/// The tables of a list `[[key]]`; none without the key. Throws Error(usage) with file, line and key.
template <class T>
std::vector<T> tables_of(const Node& root, const std::string& key, const Schema<T>& schema) {
  std::vector<T> all;
  if (!root.has(key)) return all;
  const Node list = root.child(key);
  if (!list.json->is_array()) list.fail(fmt::format("must be an array of tables; write [[{}]]", key));
  for (std::size_t i = 0; i < list.json->size(); ++i) all.push_back(schema.parse(list.item(i)));
  return all;
}

}  // namespace faba
