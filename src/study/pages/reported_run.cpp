#include "study/pages/reported_run.h"

#include <fmt/format.h>

#include "app/sinks/run_files.h"
#include "study/pages/run_report.h"

namespace faba {

bool run_with_report(Session& session) {
  if (!session.run()) return false;
  write_run_report(session.dir(), run_info(session.manifest()), session.series(), session.frames());
  session.complete();
  return true;
}

bool run_with_report(BenchSession& session) {
  bool complete = false;
  try {
    complete = session.run();
  } catch (const Error& e) {
    std::error_code ec;  // the recorded data get a report, too
    const bool recorded = std::filesystem::exists(session.dir() / run_files::kManifest, ec);
    try {
      if (recorded) write_run_report(session.dir(), run_info(session.manifest()), session.series());
    } catch (const Error&) {  // the error that stopped the run is reported instead
    }
    if (!recorded) throw;
    throw Error(e.code(), e.where(),
                fmt::format("{}; the recorded data are in {}", e.reason(), session.dir().string()));
  }
  write_run_report(session.dir(), run_info(session.manifest()), session.series());
  if (complete) session.complete();
  return complete;
}

}  // namespace faba
