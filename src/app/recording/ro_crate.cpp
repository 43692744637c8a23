#include "app/recording/ro_crate.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "app/sinks/run_files.h"

namespace faba {
namespace {

constexpr const char* kProgram = "#faba";
constexpr const char* kAction = "#run";
constexpr const char* kLicence = "#licence";
constexpr const char* kProfile = "https://w3id.org/ro/wfrun/process/0.5";
constexpr const char* kSpecification = "https://w3id.org/ro/crate/1.1";

struct RunFile {
  const char *name, *format, *description;
};
constexpr RunFile kFiles[] = {
    {run_files::kManifest, "application/json", "Description of the run, with the state hash of its result"},
    {"series.csv", "text/csv", "Swarm, setpoint, field and currents in every frame"},
    {"tracks.h5", "application/x-hdf5", "Position of every cell in every recorded frame"},
    {"video.mp4", "video/mp4", "Video of the swarm"},
    {"video.avi", "video/x-msvideo", "Lossless video of the swarm"},
    {"flow.h5", "application/x-hdf5", "Optical flow between camera frames"},
    {run_files::kCommands, "text/csv", "Commands to the coils and their inputs"},
    {"latency.csv", "text/csv", "Latency of every frame"},
    {run_files::kCoilsLog, "text/plain", "Log of the process that controls the coils"},
    {"report.html", "text/html", "Plots, metrics and the video"}};

Json reference(const std::string& id) { return {{"@id", id}}; }

Json file_entity(const RunFile& f) {
  return {{"@id", f.name},
          {"@type", "File"},
          {"name", f.name},
          {"encodingFormat", f.format},
          {"description", f.description}};
}

std::string description_of(const Manifest& m) {
  if (m.simulated)
    return fmt::format("Simulation of {} magnetotactic bacteria for {:g} s (seed {}, state hash {})",
                       m.simulated->cells, m.duration_s, m.seed, m.simulated->state_hash);
  return fmt::format("Recording of a control loop on a bench for {:g} s", m.duration_s);
}

void collect_inputs(const Json& value, std::vector<std::string>& names) {
  for (const auto& [key, member] : value.items()) {
    if (member.is_structured()) {
      collect_inputs(member, names);
    } else if ((key == "file" || key == "background") && member.is_string() &&
               !member.get_ref<const std::string&>().empty()) {
      const std::filesystem::path file(member.get<std::string>());
      const std::string name = (file.has_filename() ? file : file.parent_path()).filename().string();
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  }
}

// The members that all crates of this program have.
Json fixed_entities() {
  return {
      {{"@id", "ro-crate-metadata.json"},
       {"@type", "CreativeWork"},
       {"about", reference("./")},
       {"conformsTo", reference(kSpecification)}},
      {{"@id", kProfile}, {"@type", "CreativeWork"}, {"name", "Process Run Crate"}, {"version", "0.5"}},
      {{"@id", kLicence},
       {"@type", "CreativeWork"},
       {"name", "No licence stated"},
       {"description", "The owner of the data has not stated a licence; replace this before publication"}},
      {{"@id", kProgram},
       {"@type", "SoftwareApplication"},
       {"name", "Faba"},
       {"description", "A laboratory for magnetotactic bacteria"},
       {"version", FABA_VERSION},
       {"softwareVersion", FABA_VERSION}}};
}

}  // namespace

std::vector<std::string> input_files(const Json& resolved_scenario) {
  std::vector<std::string> names;
  collect_inputs(resolved_scenario, names);
  return names;
}

Json ro_crate(const Manifest& m, const std::filesystem::path& dir, const std::vector<std::string>& inputs,
              const std::string& end_date) {
  Json graph = fixed_entities(), parts = Json::array({reference(run_files::kScenario)}),
       objects = Json::array({reference(run_files::kScenario)}), results = Json::array();
  graph.push_back(
      file_entity({run_files::kScenario, "application/toml",
                   "Scenario with all defaults and the seed, from which the run can be repeated"}));
  for (const RunFile& f : kFiles) {
    std::error_code ec;
    if (!std::filesystem::exists(dir / f.name, ec)) continue;
    graph.push_back(file_entity(f));
    parts.push_back(reference(f.name));
    results.push_back(reference(f.name));
  }
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const std::string id = fmt::format("#input-{}", i + 1);
    graph.push_back({{"@id", id},
                     {"@type", "CreativeWork"},
                     {"name", inputs[i]},
                     {"description", "File that the scenario names; it is not in this directory"}});
    objects.push_back(reference(id));
  }
  graph.push_back({{"@id", "./"},
                   {"@type", "Dataset"},
                   {"conformsTo", reference(kProfile)},
                   {"name", m.title.empty() ? "Run of Faba" : m.title},
                   {"description", description_of(m)},
                   {"datePublished", m.date},
                   {"license", reference(kLicence)},
                   {"hasPart", parts},
                   {"mentions", reference(kAction)}});
  graph.push_back({{"@id", kAction},
                   {"@type", "CreateAction"},
                   {"name", m.simulated ? "Simulation" : "Run on a bench"},
                   {"startTime", m.date},
                   {"endTime", end_date},
                   {"actionStatus", reference("http://schema.org/CompletedActionStatus")},
                   {"instrument", reference(kProgram)},
                   {"object", objects},
                   {"result", results}});
  return {{"@context", std::string(kSpecification) + "/context"}, {"@graph", graph}};
}

}  // namespace faba
