#include "app/scenario/read_scenario.h"

#include <fmt/format.h>

#include "app/scenario/calibration_file.h"
#include "app/scenario/control_rules.h"
#include "app/scenario/file_kind.h"
#include "app/scenario/rig_file.h"
#include "app/scenario/section.h"

namespace faba {
namespace {

// In TOML a key belongs to the last [header] before it: a frequent error is a top-level key below a table.
void check_top_level(const Node& root) {
  for (const auto& [table, content] : root.json->items()) {
    const bool list = content.is_array() && !content.empty();
    const Node n = list ? root.child(table).item(content.size() - 1) : root.child(table);
    for (const char* key : {"title", "seed", "duration"})
      if (n.json->is_object() && n.json->contains(key))
        throw Error(Errc::usage, n.where(key),
                    fmt::format("is a top-level key of the scenario; write {} above the first [table]", key));
  }
}

// First the sections of the file, then the defaults of the missing parts in reverse order, because the
// default estimator depends on the controller; composed sections last, because they depend on all others.
void read_sections(const Node& root, const Parts& parts, Scenario& s) {
  std::vector<const Section*> all;
  for (const Section& section : scenario_sections())
    if (section.readable(parts)) all.push_back(&section);
  for (const Section* section : all)
    if (section->kind != Section::Kind::composed && root.has(section->key)) section->read(root, parts, s);
  for (std::size_t i = all.size(); i-- > 0;)
    if (all[i]->kind == Section::Kind::part && !root.has(all[i]->key)) all[i]->fill_in(root, parts, s);
  check_control(root, s, parts);
  for (const Section* section : all) {
    if (section->kind != Section::Kind::composed) continue;
    if (root.has(section->key))
      section->read(root, parts, s);
    else if (section->fill_in)
      section->fill_in(root, parts, s);
  }
}

void check_recorded_part(const Node& root, const Scenario& s) {
  const FrameRange part = s.recorded_frames();
  if (part.first < part.end) return;
  if (!s.record.to || *s.record.to >= s.params.duration)
    throw Error(
        Errc::usage, root.where("record.from"),
        fmt::format("{:g} s is not before the end of the run at {:g} s; decrease it or increase duration",
                    s.record.from, s.params.duration));
  throw Error(Errc::usage, root.where("record.to"),
              fmt::format("{:g} s is not after record.from = {:g} s, no frame is between them; increase it",
                          *s.record.to, s.record.from));
}

}  // namespace

Scenario read_scenario(Document d, const Parts& parts) {
  d.table_reader = parts.readers.table;
  include_rig(d, parts);
  include_calibration(d);
  const Node root(d);
  require_kind(root, FileKind::scenario);
  check_top_level(root);
  Scenario s;
  s.readers = parts.readers;
  std::vector<std::string> keys;
  for (const Section& section : scenario_sections()) keys.push_back(section.key);
  s.params = Scenario::schema().parse(root, keys);
  read_sections(root, parts, s);
  if (s.params.duration * s.camera.rate > 1e8)
    root.child("duration").fail("the run has more than 1e8 frames; reduce duration or camera.rate");
  if (s.exclusion.order == Exclusion::Order::none && s.arena.make({s.si_scale()})->needs_exclusion())
    throw Error(Errc::usage, root.where("arena"),
                "limits = \"reject\" needs exclusion; use \"clamp\" or \"reflect\"");
  check_recorded_part(root, s);
  return s;
}

}  // namespace faba
