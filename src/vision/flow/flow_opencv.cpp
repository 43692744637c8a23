#include <opencv2/video/tracking.hpp>

#include "vision/flow/flow.h"

namespace faba {
namespace {

// Both methods take 8-bit pictures.
void rounded(const GrayF& from, cv::Mat& to) {
  const cv::Mat m(from.height, from.width, CV_32F, const_cast<float*>(from.px.data()));
  m.convertTo(to, CV_8U);
}

void split_channels(const cv::Mat& flow, Flow& out) {
  if (out.width() != flow.cols || out.height() != flow.rows) out.u = out.v = GrayF(flow.cols, flow.rows);
  for (int r = 0; r < flow.rows; ++r) {
    const auto* row = flow.ptr<cv::Vec2f>(r);
    for (int c = 0; c < flow.cols; ++c) {
      out.u.at(c, r) = row[c][0];
      out.v.at(c, r) = row[c][1];
    }
  }
}

// Sets OpenCV to one thread, so that the result does not depend on the number of threads.
struct OneThread {
  int before = cv::getNumThreads();
  OneThread() { cv::setNumThreads(1); }
  ~OneThread() { cv::setNumThreads(before); }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;
};

/// Dense inverse search, Kroeger et al. 2016, implementation of OpenCV.
class Dis final : public FlowMethod {
 public:
  enum class Preset { ultrafast, fast, medium };
  struct Params {
    Preset quality = Preset::medium;
  };
  static Schema<Params> schema() {
    return Schema<Params>("dis", "Optical flow by dense inverse search (OpenCV): fast, for large motion")
        .add("quality", &Params::quality,
             {.doc = "OpenCV preset: accuracy against computing time",
              .choices = {"ultrafast", "fast", "medium"}})
        .validity(
            "Frames are rounded to 8 bits. Pictures smaller than 16 x 16 px are refused. Displacements of "
            "single cells by more than their size per frame are not detected.");
  }
  Dis(const Params& p, const FlowContext&) : dis_(cv::DISOpticalFlow::create(int(p.quality))) {}

  void between(const GrayF& a, const GrayF& b, Flow& out) override {
    if (a.width < 16 || a.height < 16)
      throw Error(Errc::input, "dis",
                  "frames of " + std::to_string(a.width) + " x " + std::to_string(a.height) +
                      " px are too small; they must be at least 16 x 16 px, or use horn_schunck");
    const OneThread one_thread;
    rounded(a, a_);
    rounded(b, b_);
    dis_->calc(a_, b_, flow_);
    split_channels(flow_, out);
  }

 private:
  cv::Ptr<cv::DISOpticalFlow> dis_;
  cv::Mat a_, b_, flow_;
};

/// Polynomial expansion, Farneback 2003, implementation of OpenCV.
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
             {.min = 0.1, .max = 0.95, .doc = "Scale of a pyramid level relative to the next finer one"})
        .add("levels", &Params::levels, {.min = 1, .max = 20, .doc = "Number of pyramid levels"})
        .add("window", &Params::window,
             {.unit = "px", .min = 3, .max = 201, .doc = "Side of the averaging window"})
        .add("iterations", &Params::iterations, {.min = 1, .max = 100, .doc = "Iterations per pyramid level"})
        .add("neighbourhood", &Params::neighbourhood,
             {.unit = "px", .min = 3, .max = 15, .doc = "Side of the neighbourhood of the polynomial fit"})
        .add("sigma", &Params::sigma,
             {.unit = "px",
              .min = 0.1,
              .max = 10,
              .doc = "Standard deviation of the Gaussian weight of the neighbourhood"})
        .validity(
            "Frames are rounded to 8 bits. The averaging window blurs differences of motion between "
            "neighbouring objects.");
  }
  Farneback(const Params& p, const FlowContext&) : p_(p) {}

  void between(const GrayF& a, const GrayF& b, Flow& out) override {
    const OneThread one_thread;
    rounded(a, a_);
    rounded(b, b_);
    cv::calcOpticalFlowFarneback(a_, b_, flow_, p_.scale, p_.levels, p_.window, p_.iterations,
                                 p_.neighbourhood, p_.sigma, 0);
    split_channels(flow_, out);
  }

 private:
  Params p_;
  cv::Mat a_, b_, flow_;
};

}  // namespace

void add_dis(FlowRegistry& r) { r.add<Dis>(); }
void add_farneback(FlowRegistry& r) { r.add<Farneback>(); }

}  // namespace faba
