#pragma once
#include "app/bench/bench_session.h"

namespace faba {

/// Runs a session on a bench and writes the report into its directory, also after an error if something was
/// recorded; the error then names the directory. Returns whether the end of the run was reached.
bool run_with_report(BenchSession& session);

}  // namespace faba
