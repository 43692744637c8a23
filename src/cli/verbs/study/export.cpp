#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "cli/command_line.h"
#include "cli/output_file.h"
#include "cli/study_job.h"
#include "core/counted.h"
#include "core/error.h"
#include "study/sweep/result_table.h"

namespace faba::cli {
namespace {

struct ExportVerb {
  std::filesystem::path dir, out;
  bool force = false;
};

int study_export(const ExportVerb& v, const Common& c) {
  check_output(v.out, {".csv", ".h5"}, v.force, {});
  const StoredStudy stored = stored_study(v.dir);
  const auto job = study_job(stored.source, false);
  const ResultStore store(v.dir / study_files::kResults, stored.hash);
  const auto round_of = [&](const PlannedRound& p) {
    return job->round(v.dir / study_files::kMeasured, p.description);
  };
  const ResultTable table(store, planned_rounds(v.dir, stored.hash), round_of, job->value_names());
  if (table.rows() == 0)
    throw Error(Errc::input, v.dir.string(),
                "has no results of a planned or complete round; compute the study first");
  if (table.rows() < store.size() && !c.quiet)
    print_stderr(fmt::format("faba: note: {} of a round that is not complete {} not in the table",
                             counted(std::uint64_t(store.size() - table.rows()), "result"),
                             store.size() - table.rows() == 1 ? "is" : "are"));
  if (v.out.extension() == ".csv")
    table.write_csv(v.out);
  else
    table.write_hdf5(v.out);
  if (c.json)
    fmt::print("{}\n", nlohmann::ordered_json{{"out", v.out.string()}, {"tasks", table.rows()}}.dump());
  else if (!c.quiet)
    fmt::print("wrote {}: {}\n", v.out.string(), counted(table.rows(), "task"));
  return 0;
}

}  // namespace

void add_study_export(CLI::App& study, CommandLine& line) {
  const auto o = std::make_shared<ExportVerb>();
  CLI::App* v = verb(study, line, "export", "Write the results of all tasks of a study as a table",
                     "  faba study export runs/mine --out tasks.csv\n"
                     "  faba study export runs/mine --out tasks.h5");
  v->add_option("dir", o->dir, "Directory of the study")->required();
  v->add_option("-o,--out", o->out, "Table to write")->required()->type_name("FILE.csv|FILE.h5");
  v->add_flag("--force", o->force, "Replace the file if it exists");
  v->callback([o, &line] { line.code = study_export(*o, line.common); });
}

}  // namespace faba::cli
