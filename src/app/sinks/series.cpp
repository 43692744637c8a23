#include "app/sinks/series.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <limits>

#include "app/sinks/series_row.h"
#include "core/file.h"

namespace faba {
namespace {

constexpr std::size_t kMaxRowsInMemory = 1'000'000;

class Series final : public SeriesSink {
 public:
  Series(const SinkContext& c, std::uint64_t keep)
      : row_(c),
        path_(c.dir / "series.csv"),
        file_(path_, keep),
        kept_(keep == 0),
        columns_(row_.names().size()) {
    if (keep == 0) file_.append(fmt::format("{}\n", fmt::join(row_.names(), ",")));
  }

  void take(const Tick& t) override {
    const std::vector<double> values = row_.values(t);
    kept_ = kept_ && columns_.front().size() < kMaxRowsInMemory;
    if (!kept_) columns_ = {};
    std::string line;
    for (std::size_t k = 0; k < values.size(); ++k) {
      const std::string field = std::isfinite(values[k]) ? fmt::format("{:.9g}", values[k]) : "";
      if (k > 0) line += ',';
      line += field;
      // The rounded value of the file, so that readers of the file get the same metrics.
      if (kept_)
        columns_[k].push_back(field.empty() ? std::numeric_limits<double>::quiet_NaN()
                                            : std::strtod(field.c_str(), nullptr));
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
  Table rows() const override {
    return kept_ ? Table(path_.string(), row_.names(), columns_) : read_table(path_, LastLine::drop);
  }

 private:
  SeriesRow row_;
  std::filesystem::path path_;
  OutputFile file_;
  bool kept_;  ///< columns_ holds all rows
  std::vector<std::vector<double>> columns_;
};

}  // namespace

std::unique_ptr<SeriesSink> series_sink(const SinkContext& c, Archive* resume) {
  std::uint64_t keep = 0;
  if (resume) *resume& keep;
  return std::make_unique<Series>(c, keep);
}

}  // namespace faba
