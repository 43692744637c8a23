#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "core/table.h"

namespace faba {
using Json = nlohmann::ordered_json;

/// A configuration file as a JSON tree, with the origin of each value.
struct Document {
  std::string name;  ///< file name as the user gave it
  Json root = Json::object();
  std::map<std::string, std::string>
      origin;  ///< path such as `swarm[0].count` -> "scenes/x.toml:12" or "--set"
  /// Reads the tables of numbers that the document names; CSV only if empty.
  std::function<Table(const std::filesystem::path&)> table_reader = {};

  /// Replaces or adds one value, as `--set swarm[0].model.speed="150 um/s"` does. `value` is parsed as TOML;
  /// otherwise it is a plain string, so that a shell command needs one pair of quotes. Missing tables are
  /// created; an array must already have the element. Throws Error(usage) with the path.
  void set(const std::string& path, const std::string& value, const std::string& origin_label);
  void set(const std::string& path, Json value, const std::string& origin_label);
};

/// A location in a Document, from which schemas read.
struct Node {
  const Json* json = nullptr;
  std::string path;  ///< "" is the root
  const Document* document = nullptr;

  explicit Node(const Document& d) : json(&d.root), document(&d) {}
  Node(const Json& j, std::string p, const Document* d) : json(&j), path(std::move(p)), document(d) {}
  /// Throws Error(usage) unless this is a table with `key`.
  Node child(const std::string& key) const;
  Node item(std::size_t i) const;
  bool has(const std::string& key) const { return json->is_object() && json->contains(key); }
  /// "scenes/x.toml:12: swarm[0].count"; the line is that of the nearest parent with a known line.
  std::string where(const std::string& key = "") const;
  [[noreturn]] void fail(const std::string& what) const;
  /// The file `name`: relative to the document if it exists there, otherwise to the working directory.
  std::filesystem::path file(const std::string& name) const;
  /// The table of numbers in that file, read by the document's table_reader. Throws Error(input).
  Table table(const std::string& name) const;
};

/// Reads a TOML file. Throws Error(usage) with file and line if it is missing, a directory, over 4 MiB or
/// invalid.
Document read_toml(const std::filesystem::path& file);
/// The same from text in memory; `name` is the file name in messages.
Document parse_toml(std::string_view text, const std::string& name);

/// Converts a tree of objects, arrays, strings, numbers and booleans to TOML, in the order of the tree. Nulls
/// are left out.
std::string to_toml(const Json& root);

}  // namespace faba
