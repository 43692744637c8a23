#include "vision/files/tiff_export.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/error.h"
#include "vision/files/frame_interval.h"

namespace faba {
namespace {

constexpr double kSameRate = 1e-3;  // relative difference of frame rates that rounded time stamps explain

TiffPixels pixels_of(int bits, bool colour) {
  if (colour) return TiffPixels::colour;
  return bits <= 8 ? TiffPixels::grey8 : bits <= 16 ? TiffPixels::grey16 : TiffPixels::grey_float;
}

template <class Integer>
void write_rounded(const GrayF& frame, const std::filesystem::path& out, Image<Integer>& page,
                   TiffWriter& writer) {
  constexpr auto kMost = float(std::numeric_limits<Integer>::max());
  page.width = frame.width;
  page.height = frame.height;
  page.px.resize(frame.px.size());
  for (std::size_t i = 0; i < page.px.size(); ++i) {
    const float value = std::nearbyint(frame.px[i]);
    if (!(value >= 0 && value <= kMost))
      throw Error(
          Errc::input, out.string(),
          fmt::format("the video has the value {:g}, but values of {} bits must be between 0 and {:g}; "
                      "convert its pixels to 32-bit floats first",
                      double(frame.px[i]), 8 * sizeof(Integer), double(kMost)));
    page.px[i] = Integer(value);
  }
  writer.write(page);
}

/// Reads the frames of a video and writes them as pages.
class Pages {
 public:
  Pages(VideoReader& video, const TiffExport& job, TiffPixels pixels)
      : video_(video), job_(job), pixels_(pixels), writer_(job.out, video.width(), video.height(), pixels) {}
  bool read(double& t_s) {
    return pixels_ == TiffPixels::colour ? video_.read_colours(colour_, t_s) : video_.read(grey_, t_s);
  }
  void write() {
    if (pixels_ == TiffPixels::colour) return writer_.write(colour_);
    if (pixels_ == TiffPixels::grey_float) return writer_.write(grey_);
    if (pixels_ == TiffPixels::grey8) return write_rounded(grey_, job_.out, grey8_, writer_);
    write_rounded(grey_, job_.out, grey16_, writer_);
  }
  TiffWriter& writer() { return writer_; }

 private:
  VideoReader& video_;
  const TiffExport& job_;
  TiffPixels pixels_;
  TiffWriter writer_;
  GrayF grey_;
  RgbImage colour_;
  Gray8 grey8_;
  Image<std::uint16_t> grey16_;
};

}  // namespace

TiffExported export_tiff(VideoReader& video, const TiffExport& job) {
  TiffExported done;
  done.pixels = pixels_of(video.bits(), job.colour);
  Pages pages(video, job, done.pixels);
  std::vector<double> times;
  std::int64_t read = job.from_s > 0 ? video.skip_to(job.from_s) : 0;
  for (double t_s = 0;; ++read) {
    if (job.progress && !job.progress(read, video.frames_in_header()))
      throw Error(Errc::interrupted, job.out.string(), "stopped before the end; no file was written");
    if (!pages.read(t_s) || (job.to_s && t_s > *job.to_s)) break;
    if (t_s < job.from_s) continue;
    times.push_back(t_s);
    pages.write();
  }
  done.frames = pages.writer().pages();
  if (done.frames == 0)
    throw Error(Errc::input, job.out.string(),
                fmt::format("the video has no frames after {:g} s{}; change --from and --to", job.from_s,
                            job.to_s ? fmt::format(" and before {:g} s", *job.to_s) : ""));
  const std::optional<FrameInterval> measured = frame_interval(times);
  done.regular = !measured || measured->regular;
  if (const double fps = video.fps(); fps > 0) {  // else times are numbers of frames
    const bool other = measured && std::fabs(measured->s * fps - 1) > kSameRate;
    done.frame_s = other ? measured->s : 1 / fps;
  }
  done.damage = video.damage();
  done.big =
      pages.writer().finish(tiff_kind(job.out).value_or(TiffKind::imagej), {job.um_per_px, done.frame_s});
  return done;
}

}  // namespace faba
