#include "server/shown/page_message.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "core/json_input.h"

namespace faba {
namespace {

constexpr std::array<std::pair<const char*, PageMessage::Do>, 11> kWords = {{
    {"start", PageMessage::Do::start},
    {"exchange", PageMessage::Do::exchange},
    {"pause", PageMessage::Do::pause},
    {"go", PageMessage::Do::go},
    {"step", PageMessage::Do::step},
    {"speed", PageMessage::Do::speed},
    {"restart", PageMessage::Do::restart},
    {"steer", PageMessage::Do::steer},
    {"look", PageMessage::Do::look},
    {"save", PageMessage::Do::save},
    {"ping", PageMessage::Do::ping},
}};
constexpr double kMostSites = 4096;  // more than the pixels of a screen
constexpr double kLongestRun = 1e6;  // s
constexpr std::uint64_t kMostSeed = 1ull << 53;

Error bad(const std::string& where, const std::string& what) { return {Errc::usage, where, what}; }

Json parse(std::string_view text) {
  Json j = parse_json(text);
  if (j.is_discarded()) throw bad("invalid message", "not valid JSON, or its nesting is too deep");
  if (!j.is_object()) throw bad("invalid message", "not a JSON object");
  return j;
}

double number(const Json& j, const char* key, double low, double high) {
  if (!j.contains(key) || !j[key].is_number()) throw bad(key, "must be a number");
  const double v = j[key];
  if (!(v >= low && v <= high))
    throw bad(key, fmt::format("{:g} is out of range; it must be between {:g} and {:g}", v, low, high));
  return v;
}

const Json& table(const Json& j, const char* key) {
  if (!j.contains(key) || !j[key].is_object()) throw bad(key, "must be an object");
  return j[key];
}

}  // namespace

PageMessage parse_page_message(std::string_view text) {
  const Json j = parse(text);
  PageMessage m;
  m.id = std::int64_t(number(j, "id", 0, 9e15));
  if (!j.contains("do") || !j["do"].is_string()) throw bad("do", "must be a string");
  const auto word = j["do"].get<std::string>();
  const auto it = std::find_if(kWords.begin(), kWords.end(), [&](const auto& w) { return word == w.first; });
  if (it == kWords.end()) throw bad("do", "unknown request \"" + word.substr(0, 40) + "\"");
  m.what = it->second;
  using Do = PageMessage::Do;
  switch (m.what) {
    case Do::start:
      m.scenario = table(j, "scenario");
      if (j.contains("seed")) m.seed = std::uint64_t(std::floor(number(j, "seed", 0, double(kMostSeed))));
      break;
    case Do::exchange:
      m.event = table(j, "event");
      break;
    case Do::step:
      if (j.contains("frames")) m.frames = std::uint64_t(number(j, "frames", 1, 1e6));
      break;
    case Do::speed:
      m.factor = number(j, "factor", 0.1, 32);
      break;
    case Do::look:
      m.camera = j.value("camera", Json(false)) == true;
      if (j.contains("rate")) m.rate = number(j, "rate", 0.1, 240);
      if (j.contains("sites")) m.sites = int(number(j, "sites", 0, kMostSites));
      break;
    case Do::save:
      if (!j.contains("name") || !j["name"].is_string()) throw bad("name", "must be a string");
      m.name = j["name"];
      m.as_seen = j.value("as_seen", Json(false)) == true;
      if (j.contains("from")) m.from = number(j, "from", 0, kLongestRun);
      if (j.contains("to")) m.to = number(j, "to", 0, kLongestRun);
      break;
    case Do::pause:
    case Do::go:
    case Do::restart:
    case Do::steer:
    case Do::ping:
      break;
  }
  return m;
}

std::int64_t message_id(std::string_view text) {
  try {
    return std::int64_t(number(parse(text), "id", 0, 9e15));
  } catch (const Error&) {
    return 0;
  }
}

}  // namespace faba
