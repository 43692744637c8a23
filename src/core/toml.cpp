#include "core/toml.h"

namespace faba {
namespace {
struct NotToml {};
constexpr void require(bool holds) {
  if (!holds) throw NotToml();
}
}  // namespace
}  // namespace faba
// toml++ 3.3 has assertions for some invalid input, such as a header that starts with "[+".
#define TOML_ASSERT(expr) faba::require(static_cast<bool>(expr))

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "core/counted.h"
#include "core/error.h"
#include "core/toml_advice.h"

namespace faba {
namespace {

std::string joined(const std::string& path, std::string_view key) {
  return path.empty() ? std::string(key) : fmt::format("{}.{}", path, key);
}

Json convert(const toml::node& n, const std::string& path, Document& doc) {
  if (n.source().begin.line) doc.origin[path] = fmt::format("{}:{}", doc.name, n.source().begin.line);
  if (const auto* t = n.as_table()) {
    // toml++ sorts keys by name; sort by line, so that a resolved scenario has the order of the user's file.
    std::vector<std::pair<toml::source_position, std::string_view>> keys;
    for (const auto& [k, v] : *t) keys.emplace_back(v.source().begin, k.str());
    std::stable_sort(keys.begin(), keys.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    Json j = Json::object();
    for (const auto& [_, k] : keys) j[std::string(k)] = convert(*t->get(k), joined(path, k), doc);
    return j;
  }
  if (const auto* a = n.as_array()) {
    Json j = Json::array();
    for (std::size_t i = 0; i < a->size(); ++i)
      j.push_back(convert((*a)[i], fmt::format("{}[{}]", path, i), doc));
    return j;
  }
  if (const auto* s = n.as_string()) return s->get();
  if (const auto* i = n.as_integer()) return i->get();
  if (const auto* d = n.as_floating_point()) return d->get();
  if (const auto* b = n.as_boolean()) return b->get();
  throw Error(Errc::usage, fmt::format("{}:{}: {}", doc.name, n.source().begin.line, path),
              "dates and times are not supported");
}

struct Step {
  std::string key;
  std::vector<std::size_t> index;
};
std::vector<Step> split(const std::string& path) {
  const auto bad = [&] {
    return Error(Errc::usage, "--set " + path, "invalid path; write it like swarm[0].model.speed");
  };
  std::vector<Step> steps;
  std::istringstream in(path);
  for (std::string part; std::getline(in, part, '.');) {
    Step s;
    const auto bracket = part.find('[');
    s.key = part.substr(0, bracket);
    if (s.key.empty()) throw bad();
    for (auto at = bracket; at != std::string::npos && at < part.size();) {
      const auto close = part.find(']', at);
      if (part[at] != '[' || close == std::string::npos || close == at + 1 || close - at > 8) throw bad();
      for (auto c = at + 1; c < close; ++c)
        if (part[c] < '0' || part[c] > '9') throw bad();
      s.index.push_back(std::stoul(part.substr(at + 1, close - at - 1)));
      at = close + 1;
    }
    steps.push_back(std::move(s));
  }
  if (steps.empty() || path.back() == '.') throw bad();
  return steps;
}

bool is_table_list(const Json& j) {
  if (!j.is_array() || j.empty()) return false;
  for (const auto& e : j)
    if (!e.is_object()) return false;
  return true;
}

// A key that is not bare, such as "swarm[0].count", is in quotes.
std::string written_key(const std::string& key) {
  const auto bare = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  if (!key.empty() && std::all_of(key.begin(), key.end(), bare)) return key;
  std::string quoted;
  for (const char c : Json(key).dump()) c == '\x7f' ? quoted += "\\u007f" : quoted += c;
  return quoted;
}

void emit_value(const Json& j, std::string& out) {
  if (j.is_array()) {
    out += '[';
    for (std::size_t i = 0; i < j.size(); ++i) {
      if (i) out += ", ";
      emit_value(j[i], out);
    }
    out += ']';
  } else if (j.is_object()) {
    out += "{ ";
    bool first = true;
    for (const auto& [k, v] : j.items()) {
      if (v.is_null()) continue;
      out += fmt::format("{}{} = ", first ? "" : ", ", written_key(k));
      emit_value(v, out);
      first = false;
    }
    out += " }";
  } else {
    for (const char c : j.dump())
      c == '\x7f' ? out += "\\u007f" : out += c;  // all other JSON scalars are valid TOML
  }
}

void emit_table(const Json& table, const std::string& path, std::string& out) {
  for (const auto& [k, v] : table.items())
    if (!v.is_null() && !v.is_object() && !is_table_list(v)) {
      out += written_key(k) + " = ";
      emit_value(v, out);
      out += '\n';
    }
  for (const auto& [k, v] : table.items()) {
    const std::string here = joined(path, written_key(k));
    if (v.is_object()) {
      out += fmt::format("\n[{}]\n", here);
      emit_table(v, here, out);
    } else if (is_table_list(v)) {
      for (const auto& e : v) {
        out += fmt::format("\n[[{}]]\n", here);
        emit_table(e, here, out);
      }
    }
  }
}

// End of the string that starts at `i` with a quote: one past its closing quotes; if they are missing, the
// end of the line or of the text.
std::size_t end_of_string(std::string_view text, std::size_t i) {
  const std::string_view quote = text.substr(i, 1), three = text.substr(i, 3);
  const bool many_lines = three.size() == 3 && three[1] == three[0] && three[2] == three[0];
  const std::string_view closing = many_lines ? three : quote;
  for (i += closing.size(); i < text.size(); ++i) {
    if (text.substr(i, closing.size()) == closing) return i + closing.size();
    if (text[i] == '\n' && !many_lines) return i;
    if (text[i] == '\\' && quote == "\"") ++i;
  }
  return text.size();
}

// Advice if the text starts with a typographic quote, in UTF-8.
std::string quote_advice(std::string_view text) {
  for (const std::string_view quote : {"\u201c", "\u201d", "\u201e", "\u2018", "\u2019", "\u00ab", "\u00bb"})
    if (text.starts_with(quote))
      return fmt::format("{} is a typographic quote; write a straight quote (\"); ", quote);
  return "";
}

// Line `number` of a text, from 1.
std::string_view line_of(std::string_view text, std::size_t number) {
  for (; number > 1 && !text.empty(); --number)
    text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
  return text.substr(0, text.find('\n'));
}

// TOML permits non-ASCII characters in strings and comments only. Elsewhere some of them cause undefined
// behaviour in toml++ 3.3.
void check_plain(std::string_view text, const std::string& name) {
  for (std::size_t i = 0; i < text.size();) {
    if (text[i] == '#') {
      i = std::min(text.find('\n', i), text.size());
    } else if (text[i] == '"' || text[i] == '\'') {
      i = end_of_string(text, i);
    } else if (static_cast<unsigned char>(text[i]) >= 0x80) {
      const auto line = 1 + std::count(text.begin(), text.begin() + std::ptrdiff_t(i), '\n');
      throw Error(Errc::usage, fmt::format("{}:{}", name, line),
                  fmt::format("{}non-ASCII characters are permitted in strings and comments only",
                              quote_advice(text.substr(i))));
    } else {
      ++i;
    }
  }
}

// The file that a user probably means by a run directory.
std::string scenario_in(const std::filesystem::path& dir) {
  const std::filesystem::path scenario = dir / "scenario.toml";
  std::error_code ec;
  return std::filesystem::exists(scenario, ec) ? fmt::format("; its scenario is {}", scenario.string()) : "";
}

}  // namespace

Document parse_toml(std::string_view text, const std::string& name) {
  Document doc;
  doc.name = name;
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // byte order mark, written by some editors
  if (text.find('\0') != text.npos) throw Error(Errc::usage, name, "is a binary file, not TOML");
  check_plain(text, name);
  try {
    const toml::table t = toml::parse(text, name);
    doc.root = convert(t, "", doc);
  } catch (const toml::parse_error& e) {
    const auto line = e.source().begin.line;
    throw Error(Errc::usage, fmt::format("{}:{}", name, line),
                toml_advice(e.description(), line_of(text, line)));
  } catch (const NotToml&) {
    throw Error(Errc::usage, name, "is not valid TOML: a key or a [header] starts with an invalid character");
  }
  return doc;
}

Document read_toml(const std::filesystem::path& file) {
  constexpr std::uintmax_t kMaxBytes = 4u << 20;
  std::error_code ec;
  if (!std::filesystem::exists(file, ec))
    throw Error(Errc::usage, file.string(), "file not found; check the name");
  if (std::filesystem::is_directory(file, ec))
    throw Error(Errc::usage, file.string(), "is a directory, not a TOML file" + scenario_in(file));
  if (std::filesystem::is_regular_file(file, ec) && std::filesystem::file_size(file, ec) > kMaxBytes)
    throw Error(Errc::usage, file.string(), "is larger than the maximum of 4 MiB");
  std::ifstream in(file, std::ios::binary);
  if (!in.is_open())
    throw Error(Errc::usage, file.string(), std::string("cannot be read: ") + std::strerror(errno));
  // In blocks: a pipe has no size, and zeros for the maximum would take longer than reading a scenario.
  std::string text;
  std::array<char, 1 << 14> block{};
  do {
    in.read(block.data(), std::streamsize(block.size()));
    text.append(block.data(), std::size_t(in.gcount()));
  } while (in && text.size() <= kMaxBytes);
  if (in.bad() || (in.fail() && !in.eof())) throw Error(Errc::usage, file.string(), "cannot be read");
  return parse_toml(text, file.string());
}

std::string to_toml(const Json& root) {
  std::string out;
  emit_table(root, "", out);
  return out;
}

void Document::set(const std::string& path, Json value, const std::string& origin_label) {
  Json* at = &root;
  std::string prefix;
  for (const Step& s : split(path)) {
    const auto fail = [&](const std::string& what) {
      throw Error(Errc::usage, fmt::format("{} {}", origin_label, path), what);
    };
    // `model = "dipole"` is short for `model = { type = "dipole" }`: setting a key of it keeps the type.
    if (at->is_string()) *at = Json{{"type", *at}};
    if (at->is_array() && !at->empty() && at->front().is_object())
      fail(fmt::format("\"{0}\" is an array; write {0}[0].{1}", prefix, s.key));
    if (!at->is_object()) fail(fmt::format("\"{}\" is not a table", prefix));
    prefix = joined(prefix, s.key);
    if (!at->contains(s.key)) {
      if (!s.index.empty())
        fail(path.find('.', prefix.size()) != path.npos
                 ? fmt::format("the file has no [[{}]]; add one for each element to the file", prefix)
                 : fmt::format("array \"{}\" not found; add it to the file", prefix));
      (*at)[s.key] = Json::object();
      origin[prefix] = origin_label;
    }
    at = &(*at)[s.key];
    for (const std::size_t i : s.index) {
      if (!at->is_array() || i >= at->size())
        fail(fmt::format("{0}[{1}] not found; \"{0}\" has {2}; add more in the file", prefix, i,
                         counted(at->is_array() ? at->size() : 0, "element")));
      at = &(*at)[i];
      prefix += fmt::format("[{}]", i);
    }
  }
  *at = std::move(value);
  // The line numbers of the replaced values are no longer valid.
  // Paths of the same subtree continue with "." or "["; "a.bc" is not a part of "a.b".
  const auto within = [&](const std::string& other) {
    return other.size() == prefix.size() || other[prefix.size()] == '.' || other[prefix.size()] == '[';
  };
  for (auto it = origin.lower_bound(prefix); it != origin.end() && it->first.starts_with(prefix);)
    it = within(it->first) ? origin.erase(it) : std::next(it);
  origin[prefix] = origin_label;
}

void Document::set(const std::string& path, const std::string& value, const std::string& origin_label) {
  Json parsed = value;
  try {
    const toml::table t = toml::parse("v = " + value);
    if (t.size() == 1) {
      Document scratch;
      parsed = convert(*t.get("v"), "", scratch);
    }
  } catch (const toml::parse_error& e) {
    // A value that does not start like a table or an array is a plain string.
    if (value.starts_with('{') || value.starts_with('['))
      throw Error(Errc::usage, fmt::format("{} {}", origin_label, path), toml_advice(e.description(), value));
  }
  try {
    parsed.dump();
  } catch (const Json::exception&) {
    throw Error(Errc::usage, fmt::format("{} {}", origin_label, path), "is not UTF-8");
  }
  set(path, std::move(parsed), origin_label);
}

Node Node::child(const std::string& key) const {
  if (!json->is_object()) fail("must be a table");
  if (!json->contains(key)) fail(fmt::format("\"{}\" is missing", key));
  return {(*json)[key], joined(path, key), document};
}
Node Node::item(std::size_t i) const { return {(*json)[i], fmt::format("{}[{}]", path, i), document}; }

std::string Node::where(const std::string& key) const {
  const std::string full = key.empty() ? path : joined(path, key);
  std::string label = document ? document->name : "";
  if (document)
    for (std::string p = full;;) {
      if (const auto it = document->origin.find(p); it != document->origin.end()) {
        label = it->second;
        break;
      }
      const auto cut = p.find_last_of(".[");
      if (cut == std::string::npos) break;
      p.resize(cut);
    }
  if (full.empty() || label == "--" + full) return label;
  // An option is one place: "--repeat" and not "--repeat: rig.step_response.repeat".
  if (label != "--set" && label.starts_with("--") && full.ends_with("." + label.substr(2))) return label;
  return label.empty() ? full : fmt::format("{}: {}", label, full);
}

void Node::fail(const std::string& what) const { throw Error(Errc::usage, where(), what); }

Table Node::table(const std::string& name) const {
  const std::filesystem::path at = file(name);
  return document && document->table_reader ? document->table_reader(at) : read_table(at);
}

std::filesystem::path Node::file(const std::string& name) const {
  if (!document) return name;
  const std::filesystem::path beside = std::filesystem::path(document->name).parent_path() / name;
  std::error_code ec;
  return std::filesystem::exists(beside, ec) ? beside : std::filesystem::path(name);
}

}  // namespace faba
