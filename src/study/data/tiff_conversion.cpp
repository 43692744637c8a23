#include "study/data/tiff_conversion.h"

#include "core/threads/ordered_work.h"
#include "study/data/run_video.h"

namespace faba {
namespace {

std::vector<std::string> notes_of(const ConvertedTiff& c) {
  std::vector<std::string> notes;
  if (!c.scale.ignored.empty()) notes.push_back(c.scale.ignored);
  if (!c.scale.um_per_px)
    notes.emplace_back("the scale is not known, so the file states none; give it with --um-per-px");
  if (!c.stack.frame_s)
    notes.emplace_back(
        "the frame rate is not known, so the file states no frame interval; give it with --fps");
  if (!c.stack.regular)
    notes.emplace_back("the frames are not at equal times; the file states their mean interval without gaps");
  if (c.stack.big && c.kind == TiffKind::imagej)
    notes.emplace_back(
        "the file exceeds 4 GB and is a BigTIFF, which ImageJ reads with Bio-Formats; for a smaller file, "
        "select a part with --from and --to");
  if (!c.stack.damage.empty()) notes.push_back("damaged frames are missing: " + c.stack.damage);
  return notes;
}

}  // namespace

ConvertedTiff convert_to_tiff(const TiffConversion& job) {
  const RunVideo source = video_or_drawing(job.video);
  VideoReader video(source.file, job.part.fps, OrderedWork::threads(job.threads));
  ConvertedTiff done{.kind = tiff_kind(job.out).value_or(TiffKind::imagej),
                     .width = video.width(),
                     .height = video.height(),
                     .scale = job.scale.um_per_px ? job.scale : source.scale,
                     .stack = {},
                     .notes = {}};
  done.stack = export_tiff(
      video, {job.out, done.scale.um_per_px, job.part.from_s, job.part.to_s, source.drawing, job.progress});
  done.notes = notes_of(done);
  return done;
}

}  // namespace faba
