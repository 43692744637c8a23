#include <opencv2/video/tracking.hpp>

#include "vision/flow/flow.h"

namespace faba {
namespace {

// Both take 8-bit pictures.
void rounded(const GrayF& from, cv::Mat& to) {
  const cv::Mat m(from.height, from.width, CV_32F, const_cast<float*>(from.px.data()));
  m.convertTo(to, CV_8U);
}

void split(const cv::Mat& flow, Flow& out) {
  if (out.width() != flow.cols || out.height() != flow.rows) out.u = out.v = GrayF(flow.cols, flow.rows);
  for (int r = 0; r < flow.rows; ++r) {
    const auto* row = flow.ptr<cv::Vec2f>(r);
    for (int c = 0; c < flow.cols; ++c) {
      out.u.at(c, r) = row[c][0];
      out.v.at(c, r) = row[c][1];
    }
  }
}

// Its result must not depend on how many threads OpenCV would take.
struct OneThread {
  int before = cv::getNumThreads();
  OneThread() { cv::setNumThreads(1); }
  ~OneThread() { cv::setNumThreads(before); }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;
};

/// Dense inverse search, Kroeger et al. 2016, as OpenCV has it.
class Dis final : public FlowMethod {
 public:
  enum class Preset { ultrafast, fast, medium };
  struct Params {
    Preset quality = Preset::medium;
  };
  static Schema<Params> schema() {
    return Schema<Params>("dis", "Optical flow by dense inverse search (OpenCV): fast, for large motion")
        .add("quality", &Params::quality,
             {.doc = "How much work is put into it", .choices = {"ultrafast", "fast", "medium"}})
        .validity(
            "Frames are rounded to 8 bits. Refuses pictures smaller than 16 px. Single cells that jump "
            "further "
            "than their own size are not followed.");
  }
  Dis(const Params& p, const FlowContext&) : dis_(cv::DISOpticalFlow::create(int(p.quality))) {}

  void between(const GrayF& a, const GrayF& b, Flow& out) override {
    if (a.width < 16 || a.height < 16)
      throw Error(Errc::input, "dis", "needs frames of 16 x 16 px or more; use horn_schunck");
    const OneThread alone;
    rounded(a, a_);
    rounded(b, b_);
    dis_->calc(a_, b_, flow_);
    split(flow_, out);
  }

 private:
  cv::Ptr<cv::DISOpticalFlow> dis_;
  cv::Mat a_, b_, flow_;
};

/// Polynomial expansion, Farneback 2003, as OpenCV has it.
class Farneback final : public FlowMethod {
 public:
  struct Params {
    double scale = 0.5;
    int levels = 3;
    int window = 15;
    int iterations = 3;
    int neighbourhood = 5;
    double sigma = 1.1;
  };
  static Schema<Params> schema() {
    return Schema<Params>("farneback", "Optical flow by polynomial expansion (OpenCV)")
        .add("scale", &Params::scale,
             {.min = 0.1, .max = 0.95, .doc = "Size of a level of the pyramid to the one below"})
        .add("levels", &Params::levels, {.min = 1, .max = 20, .doc = "Levels of the pyramid"})
        .add("window", &Params::window,
             {.unit = "px", .min = 3, .max = 201, .doc = "Side of the window averaged over"})
        .add("iterations", &Params::iterations, {.min = 1, .max = 100, .doc = "Iterations on each level"})
        .add("neighbourhood", &Params::neighbourhood,
             {.unit = "px", .min = 3, .max = 15, .doc = "Side of the square that a polynomial is fitted to"})
        .add("sigma", &Params::sigma,
             {.unit = "px",
              .min = 0.1,
              .max = 10,
              .doc = "Weight of the neighbourhood, a Gaussian's standard deviation"})
        .validity("Frames are rounded to 8 bits. The window blurs what moves differently side by side.");
  }
  Farneback(const Params& p, const FlowContext&) : p_(p) {}

  void between(const GrayF& a, const GrayF& b, Flow& out) override {
    const OneThread alone;
    rounded(a, a_);
    rounded(b, b_);
    cv::calcOpticalFlowFarneback(a_, b_, flow_, p_.scale, p_.levels, p_.window, p_.iterations,
                                 p_.neighbourhood, p_.sigma, 0);
    split(flow_, out);
  }

 private:
  Params p_;
  cv::Mat a_, b_, flow_;
};

}  // namespace

void add_dis(FlowRegistry& r) { r.add<Dis>(); }
void add_farneback(FlowRegistry& r) { r.add<Farneback>(); }

}  // namespace faba
