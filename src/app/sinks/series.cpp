#include <fmt/format.h>

#include <cmath>

#include "app/sinks/series_row.h"
#include "core/file.h"

namespace faba {
namespace {

class Series final : public RunSink {
 public:
  Series(const SinkContext& c, std::uint64_t keep) : row_(c), file_(c.dir / "series.csv", keep) {
    if (keep == 0) file_.append(fmt::format("{}\n", fmt::join(row_.names(), ",")));
  }

  void take(const Tick& t) override {
    std::string line;
    for (const double v : row_.values(t)) {
      if (!line.empty()) line += ',';
      if (std::isfinite(v)) line += fmt::format("{:.9g}", v);
    }
    file_.append(line + '\n');
  }

  void checkpoint(Archive& a) override {
    file_.sync();
    std::uint64_t length = file_.size();
    a& length;
  }
  void finish(bool) override {
    file_.sync();
    file_.close();
  }

 private:
  SeriesRow row_;
  OutputFile file_;
};

}  // namespace

std::unique_ptr<RunSink> series_sink(const SinkContext& c, Archive* resume) {
  std::uint64_t keep = 0;
  if (resume) *resume& keep;
  return std::make_unique<Series>(c, keep);
}

}  // namespace faba
