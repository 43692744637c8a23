#include "server/jobs/job_kind.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace faba {
namespace {

using In = JobInput::Kind;

const char* file_kind_name(In kind) {
  switch (kind) {
    case In::video:
      return "video";
    case In::picture:
      return "picture";
    case In::frame:
      return "frame";
    case In::table:
      return "table";
    case In::coil_system:
      return "coil_system";
    case In::study:
      return "study";
    case In::experiment:
      return "experiment";
    default:
      return nullptr;
  }
}

Json number_json(const JobInput& i, const char* type) {
  Json p = {{"type", type}};
  if (!i.unit.empty()) p["x-unit"] = i.unit;
  if (i.min > -std::numeric_limits<double>::max()) p["minimum"] = i.min;
  if (i.max < std::numeric_limits<double>::max()) p["maximum"] = i.max;
  return p;
}

Json property(const JobInput& i) {
  Json p = Json::object();
  if (const char* file = file_kind_name(i.kind)) {
    p = {{"type", "string"}, {"x-file", file}};
    if (i.many) p = {{"type", "array"}, {"items", p}, {"x-file", file}, {"minItems", 1}};
  } else if (i.kind == In::number || i.kind == In::integer || i.kind == In::direction) {
    p = number_json(i, i.kind == In::integer ? "integer" : "number");
    if (i.kind == In::direction) p["x-direction"] = true;
  } else if (i.kind == In::point || i.kind == In::currents) {
    p = {{"type", "array"}, {"items", number_json(i, "number")}};
    if (i.kind == In::currents) p["x-currents"] = true;
    if (i.kind == In::point) p.update({{"minItems", 2}, {"maxItems", 2}});
  } else if (i.kind == In::choice) {
    p = {{"type", "string"}, {"enum", i.choices}, {"default", i.choices.front()}};
  } else if (i.kind == In::flag) {
    p = {{"type", "boolean"}, {"default", false}};
  } else {
    p = {{"type", "string"}};
  }
  p["description"] = i.doc;
  return p;
}

}  // namespace

std::string JobKind::verb_text() const { return fmt::format("{}", fmt::join(verb, " ")); }

Json job_kind_json(const JobKind& k) {
  Json properties = Json::object(), required = Json::array(), outputs = Json::array();
  for (const JobInput& i : k.inputs) {
    properties[i.key] = property(i);
    if (i.required) required.push_back(i.key);
  }
  for (const JobOutput& o : k.outputs)
    if (!o.file.empty()) outputs.push_back(o.file);
  return {{"kind", k.name},
          {"group", k.group},
          {"verb", k.verb_text()},
          {"page", k.page},
          {"outputs", outputs},
          {"schema",
           {{"title", k.name},
            {"description", k.doc},
            {"type", "object"},
            {"required", required},
            {"properties", properties}}}};
}

}  // namespace faba
