#include "study/identify/response/response_archive.h"

namespace faba {
namespace {

// One description of writing and reading for each type. Elements of vectors have their type's function.
template <class T, class Each>
void archive_each(Archive& a, std::vector<T>& all, const Each& each) {
  std::uint64_t n = all.size();
  a& n;
  if (a.reading()) all.clear();
  for (std::uint64_t i = 0; i < n; ++i) {
    if (a.reading()) all.emplace_back();
    each(a, all[i]);
  }
}

template <class T, class Value>
void archive_optional(Archive& a, std::optional<T>& v, const Value& value) {
  bool has = v.has_value();
  a& has;
  if (a.reading()) v.reset();
  if (has && !v) v.emplace();
  if (has) value(a, *v);
}

void archive_number(Archive& a, double& v) { a& v; }
void archive_point(Archive& a, Vec2& v) { a& v; }
void archive_text(Archive& a, std::string& v) { a& v; }
void archive_list(Archive& a, std::vector<double>& v) { a& v; }

void archive_picture(Archive& a, GrayF& v) { a& v.width& v.height& v.px; }

void archive_segment(Archive& a, FieldSegment& s) {
  a& s.t0_s& s.t1_s& s.direction_deg;
  archive_optional(a, s.field_t, archive_number);
}

void archive_episode(Archive& a, Episode& e) {
  a& e.name& e.start_s;
  archive_each(a, e.segments, archive_segment);
  archive_each(a, e.positions_image, archive_point);
}

void archive_edge(Archive& a, DropEdge& e) {
  a& e.centre_image& e.radius_px& e.sd_centre_px& e.sd_radius_px& e.out_of_round_px;
  archive_optional(a, e.other, [](Archive& b, Circle& c) { b& c.centre& c.radius; });
  a& e.arc_deg& e.inside_image& e.centre_side_inside& e.image_width& e.image_height& e.contrast;
  a& e.edge_width_px& e.support& e.log10_false_alarms;
  archive_each(a, e.edge_points, archive_point);
  archive_each(a, e.segments, [](Archive& b, EdgeSegment& s) { b& s.a& s.b; });
}

void archive_view(Archive& a, CellView& v) {
  a& v.width& v.height& v.frame_s;
  a& v.cells.cell_px& v.cells.polarity& v.cells.threshold_sd& v.cells.absorb_s& v.cells.learn;
  a& v.threshold_sd& v.search_radius_px;
  Background b;
  if (!a.reading() && v.background) b = *v.background;
  archive_picture(a, b.level);
  archive_picture(a, b.noise_sd);
  a& b.frames;
  if (a.reading()) v.background = std::make_shared<const Background>(std::move(b));
}

void archive_histograms(Archive& a, FlowHistograms& h) {
  for (std::vector<double>* v : {&h.x, &h.y, &h.right, &h.left, &h.down, &h.up}) a&* v;
}

}  // namespace

void archive_response(Archive& a, ResponseVideo& v) {
  std::string file = v.file.string();
  a& file& v.side& v.fps& v.um_per_px& v.cell_px& v.contrast& v.segments_detected;
  v.file = file;
  archive_view(a, v.view);
  archive_optional(a, v.edge, archive_edge);
  VideoBackground ground;
  if (!a.reading() && v.ground) ground = *v.ground;
  archive_picture(a, ground.light);
  a& ground.noise_sd& v.stationary;
  if (a.reading()) v.ground = std::make_shared<const VideoBackground>(std::move(ground));
  archive_optional(a, v.field_t, archive_number);
  archive_optional(a, v.recorded_um_per_px, archive_number);
  archive_each(a, v.episodes, archive_episode);
  archive_each(a, v.observed, archive_list);
  archive_each(a, v.pictures,
               [](Archive& b, std::vector<GrayF>& all) { archive_each(b, all, archive_picture); });
  archive_each(a, v.notes, archive_text);
}

void archive_references(Archive& a, std::vector<LegacyReference>& references) {
  archive_each(a, references, [](Archive& b, LegacyReference& r) {
    b& r.times_s& r.filter.threshold_px& r.filter.direction_deg;
    archive_each(b, r.pairs, archive_histograms);
  });
}

}  // namespace faba
