#include "study/data/flow_choice.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/scenario/parts.h"

namespace faba {
namespace {

std::string not_a_parameter(const std::string& key, const std::string& method, const FlowRegistry& flows) {
  std::string text = fmt::format("not a parameter of method {}", method);
  for (const std::string& other : flows.names())
    if (flows.json_schema(other)["properties"].contains(key))
      return text + fmt::format("; it belongs to {0}: add --method {0}", other);
  return text;
}

}  // namespace

FlowRegistry::PartType flow_part(const FlowChoice& choice, const FlowChoice& defaults) {
  const FlowRegistry& methods = builtin_flow_methods();
  const std::vector<std::string> names = methods.names();
  if (std::ranges::count(names, choice.method) > 0) {  // resolve() refuses an unknown one
    const Json known = methods.json_schema(choice.method)["properties"];
    for (const auto& [key, _] : choice.values)
      if (!known.contains(key))
        throw Error(Errc::usage, "--" + key, not_a_parameter(key, choice.method, methods));
  }
  Document d;
  d.name = "--method " + choice.method;
  d.set("flow.type", Json(choice.method), "--method " + choice.method);
  if (choice.method == defaults.method)
    for (const auto& [key, value] : defaults.values) d.set("flow." + key, value, "--" + key);
  for (const auto& [key, value] : choice.values) d.set("flow." + key, value, "--" + key);
  FlowRegistry::PartType part = methods.resolve(Node(d).child("flow"));
  for (const auto& [key, _] : choice.values)
    if (key == "warps" && !part.resolved.value("pyramid", true))
      throw Error(Errc::usage, "--warps",
                  "has an effect only with --pyramid; add --pyramid, or omit --warps");
  return part;
}

std::string options_text(const FlowChoice& choice, int shrink, double fps) {
  std::string text = choice.method == FlowChoice{}.method ? "" : "--method";
  const auto add = [&](const std::string& option) { text += (text.empty() ? "--" : ", --") + option; };
  for (const auto& [key, _] : choice.values) add(key);
  if (shrink > 0) add("shrink");
  if (fps > 0) add("fps");
  return text;
}

FlowChoice published_flow() { return {"horn_schunck", {{"preset", "published"}}}; }

}  // namespace faba
