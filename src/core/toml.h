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

/// A configuration file as a JSON tree that remembers where each value came from.
struct Document {
  std::string name;  ///< file name as the user gave it
  Json root = Json::object();
  std::map<std::string, std::string>
      origin;  ///< path such as `swarm[0].count` -> "scenes/x.toml:12" or "--set"
  /// Reads the tables of numbers that the document names; CSV alone when empty.
  std::function<Table(const std::filesystem::path&)> table_reader = {};

  /// Replaces or adds one value, as `--set swarm[0].model.speed="150 um/s"` does. `value` is read as TOML;
  /// what is not TOML is taken as a plain string, so that a shell needs one pair of quotes. Tables on the way
  /// are made; a list must already have the element. Throws Error(usage) with the path.
  void set(const std::string& path, const std::string& value, const std::string& origin_label);
  void set(const std::string& path, Json value, const std::string& origin_label);
};

/// A place in a Document: what schemas read from.
struct Node {
  const Json* json = nullptr;
  std::string path;  ///< "" is the root
  const Document* document = nullptr;

  explicit Node(const Document& d) : json(&d.root), document(&d) {}
  Node(const Json& j, std::string p, const Document* d) : json(&j), path(std::move(p)), document(d) {}
  /// Throws unless this is a table holding `key`.
  Node child(const std::string& key) const;
  Node item(std::size_t i) const;
  bool has(const std::string& key) const { return json->is_object() && json->contains(key); }
  /// "scenes/x.toml:12: swarm[0].count", falling back to the nearest known parent.
  std::string where(const std::string& key = "") const;
  [[noreturn]] void fail(const std::string& what) const;
  /// The file called `name`: beside the document when it is there, else from where the program was called.
  std::filesystem::path file(const std::string& name) const;
  /// The table of numbers in that file, read by the document's table_reader. Throws Error(input).
  Table table(const std::string& name) const;
};

/// Reads a TOML file. Missing, a directory, over 4 MiB, not TOML: Error(usage) with file and line.
Document read_toml(const std::filesystem::path& file);
/// The same from text in memory; `name` stands for the file in messages.
Document parse_toml(std::string_view text, const std::string& name);

/// Writes a tree of objects, arrays, strings, numbers and booleans as TOML, in the tree's own order. Nulls
/// are left out.
std::string to_toml(const Json& root);

}  // namespace faba
