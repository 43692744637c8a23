// Optical flow compared with external references: the values of theory A22 and RubberWhale of the Middlebury
// set. Skipped if they are absent.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>

#include "core/table.h"
#include "study/pages/flow_report.h"
#include "tests/skip.h"
#include "vision/flow/horn_schunck.h"

using namespace faba;

namespace {

const std::filesystem::path kData = FABA_SHARED_DATA;
const std::filesystem::path kReference = kData / "../oracles/hs_reference.csv";

// The pictures of the reference: 16 x 16 px, a Gaussian with 200 grey levels and a standard deviation of 2.5
// px at (7, 7.5), moved by (0.6, -0.3).
Plane<double> spot(double dx, double dy) {
  Plane<double> p(16, 16);
  for (int r = 0; r < 16; ++r)
    for (int c = 0; c < 16; ++c) {
      const double x = c - 7 - dx, y = r - 7.5 - dy;
      p.row(r)[c] = 200 * std::exp(-(x * x + y * y) / (2 * 2.5 * 2.5));
    }
  return p;
}

}  // namespace

TEST_CASE("all rows of the reference agree to 1e-9") {
  if (test::skipped_without(kReference)) return;
  const Table table = read_table(kReference);
  Pool pool(1);
  const auto column = [&](const char* name) { return table.column(name); };
  REQUIRE(table.size() == 40);
  for (std::size_t i = 0; i < table.size(); ++i) {
    HornSchunckParams p;
    p.solver = FlowSolver::jacobi;
    p.tolerance = 0;
    p.alpha2 = column("alpha2")[i];
    p.iterations = int(column("iterations")[i]);
    HornSchunck<double> solver(p, pool);
    auto a = spot(0, 0), b = spot(0.6, -0.3);
    const auto& flow = solver.between(a, b);
    const int row = int(column("row")[i]), col = int(column("col")[i]);
    CHECK(std::fabs(flow.u.row(row)[col] - column("u")[i]) < 1e-9);
    CHECK(std::fabs(flow.v.row(row)[col] - column("v")[i]) < 1e-9);
    FlowDerivatives<double> d;
    differentiate(a, b, d, pool);
    // The reference has twelve digits, with numbers up to 40.
    CHECK(std::fabs(d.ix.row(row)[col] - column("Ex")[i]) < 1e-9);
    CHECK(std::fabs(d.iy.row(row)[col] - column("Ey")[i]) < 1e-9);
    CHECK(std::fabs(d.it.row(row)[col] - column("Et")[i]) < 1e-9);
  }
}

TEST_CASE("RubberWhale: endpoint error without and with a pyramid") {
  if (test::skipped_without(kData / "flow")) return;
  const auto folder = kData / "flow";
  const auto error_of = [&](const FlowChoice& choice) {
    FlowJob job;
    job.method = flow_part(choice);
    job.truth = folder / "flow10.flo";
    return flow_of_pair(folder / "frame10.png", folder / "frame11.png", job).error.value().endpoint_px;
  };
  CHECK(error_of({}) < 0.35);
  CHECK(error_of({"horn_schunck", {{"pyramid", "true"}}}) < 0.25);
  // A hundred sweeps starting from zero have not converged.
  CHECK(error_of(published_flow()) > error_of({}) + 0.05);
}
