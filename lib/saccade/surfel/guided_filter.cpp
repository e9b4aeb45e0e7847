// SPDX-License-Identifier: Apache-2.0
#include "saccade/surfel/guided_filter.hpp"

#include <hwy/aligned_allocator.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <mutex>
#include <utility>
#include <vector>

#include "saccade/surfel/internal/guided_filter_kernels.hpp"

namespace saccade {
namespace {

constexpr double kLeastSigma{1e-4};
constexpr std::size_t kGuidedRowsPerTask{
    32};  // even; a filter that also takes the next rows continues where it stopped

template <class T>
hwy::AlignedFreeUniquePtr<T[]> zeros(std::size_t count) {
  auto made = hwy::AllocateAligned<T>(std::max<std::size_t>(count, 1));
  if (made == nullptr) throw std::bad_alloc{};
  std::fill_n(made.get(), count, T{0});
  return made;
}

/// Images of one call.
struct Images {
  int height{0};
  guided::RowShape shape;
  const float* depth_m{nullptr};
  const float* guidance{nullptr};
  const std::uint8_t* used{nullptr};
  float* enhanced_m{nullptr};
};

}  // namespace

namespace guided {

/// Filter that moves down the rows of an image, two at a time: loads them, fits the two rows R and R + 1 above, and
/// enhances the two as far above those. It can continue where it stopped.
class RowFilter {
 public:
  RowFilter(const guided::RowShape& shape, const guided::Disc& disc)
      : disc_{disc},
        shape_{shape},
        lag_{disc.radius_px + disc.radius_px % 2},
        kept_{2 * lag_ + 2},
        rows_{zeros<float>(static_cast<std::size_t>(kept_) * guided::kChannels * shape.stride)},
        fits_{zeros<double>(static_cast<std::size_t>(kept_) * guided::kFits * shape.stride)},
        sums_{zeros<double>(guided::sums_of(disc))},
        enhanced_{zeros<float>(2 * shape.stride)},
        row_window_(static_cast<std::size_t>(2 * disc.radius_px + 2)),
        fit_window_(static_cast<std::size_t>(2 * disc.radius_px + 2)) {}

  /// Filters rows [begin, end) of the output; begin is even.
  void run(const Images& images, const guided::Variances& variances, int begin, int end) {
    int v = begin == next_ ? begin + 2 * lag_ : begin - 2 * lag_;
    for (; v < end + 2 * lag_; v += 2) {
      load(images, v);
      load(images, v + 1);
      if (v >= begin) fit(v - lag_, variances);
      if (v - 2 * lag_ >= begin) enhance(images, v - 2 * lag_);
    }
    next_ = end;
  }

  /// Returns the row where it continues at little cost, or kNone.
  [[nodiscard]] int next() const { return next_; }
  void forget() { next_ = kNone; }

 private:
  static constexpr int kNone{-1};
  [[nodiscard]] std::size_t slot(int v) const { return static_cast<std::size_t>((v + 2 * kept_) % kept_); }
  [[nodiscard]] float* row(int v) const { return rows_.get() + slot(v) * guided::kChannels * shape_.stride; }
  [[nodiscard]] double* fits(int v) const { return fits_.get() + slot(v) * guided::kFits * shape_.stride; }

  /// Loads a row; rows outside the image have no used pixel.
  void load(const Images& images, int v) {
    if (v < 0 || v >= images.height) {
      std::fill_n(row(v), guided::kChannels * shape_.stride, 0.0F);
      return;
    }
    const std::size_t first = static_cast<std::size_t>(v) * static_cast<std::size_t>(shape_.width);
    guided::load_row(shape_, images.depth_m + first, images.guidance + 4 * first, images.used + first, row(v));
  }

  /// Fits rows v and v + 1.
  void fit(int v, const guided::Variances& variances) {
    for (int i = 0; i <= 2 * disc_.radius_px + 1; ++i) {
      row_window_[static_cast<std::size_t>(i)] = row(v - disc_.radius_px + i);
    }
    const std::array<double*, 2> fitted{fits(v), fits(v + 1)};
    guided::fit_rows(shape_, disc_, variances, row_window_.data(), sums_.get(), fitted.data());
  }

  void enhance(const Images& images, int v) {
    for (int i = 0; i <= 2 * disc_.radius_px + 1; ++i) {
      fit_window_[static_cast<std::size_t>(i)] = fits(v - disc_.radius_px + i);
    }
    const std::array<const float*, 2> guidance{row(v), row(v + 1)};
    const std::array<float*, 2> enhanced{enhanced_.get(), enhanced_.get() + shape_.stride};
    guided::enhance_rows(shape_, disc_, guidance.data(), fit_window_.data(), sums_.get(), enhanced.data());
    const std::size_t width = static_cast<std::size_t>(shape_.width);
    for (int i = 0; i < 2 && v + i < images.height; ++i) {
      const std::size_t first = static_cast<std::size_t>(v + i) * width;
      const float* const of_row = enhanced[static_cast<std::size_t>(i)];
      for (std::size_t u = 0; u < width; ++u) {
        images.enhanced_m[first + u] = images.used[first + u] != 0 ? of_row[u] : images.depth_m[first + u];
      }
    }
  }

  guided::Disc disc_;
  guided::RowShape shape_;
  int lag_;
  int kept_;
  int next_{kNone};
  hwy::AlignedFreeUniquePtr<float[]> rows_;
  hwy::AlignedFreeUniquePtr<double[]> fits_;
  hwy::AlignedFreeUniquePtr<double[]> sums_;
  hwy::AlignedFreeUniquePtr<float[]> enhanced_;
  std::vector<const float*> row_window_;
  std::vector<const double*> fit_window_;
};

}  // namespace guided

namespace {

guided::RowShape shape_of(int width) {
  const int padded = (width + guided::kBlock - 1) / guided::kBlock * guided::kBlock;
  return {width, padded, static_cast<std::size_t>(padded + 2 * guided::kMargin)};
}

}  // namespace

/// Row filters for images of one width, one per row range that ran at once.
struct GuidedFilter::Memory {
  guided::Disc disc;
  guided::RowShape shape;
  std::mutex mutex;
  std::vector<std::unique_ptr<guided::RowFilter>> idle;

  /// Returns the filter that stopped at row `begin`, if there is one.
  std::unique_ptr<guided::RowFilter> take(int begin) {
    {
      const std::lock_guard lock{mutex};
      if (!idle.empty()) {
        const auto stopped = std::find_if(idle.begin(), idle.end(), [&](const auto& f) { return f->next() == begin; });
        if (stopped != idle.end()) std::iter_swap(stopped, std::prev(idle.end()));
        auto taken = std::move(idle.back());
        idle.pop_back();
        return taken;
      }
    }
    return std::make_unique<guided::RowFilter>(shape, disc);
  }

  void give_back(std::unique_ptr<guided::RowFilter> filter) {
    const std::lock_guard lock{mutex};
    idle.push_back(std::move(filter));
  }
};

Status GuidedFilterConfig::validate() const {
  if (radius_px < 0 || radius_px > guided::kMaxRadius_px) {
    return Error{Errc::invalid_argument, "the radius of the guided filter must be within 0 and 16 pixels", {}};
  }
  if (!(color_sigma >= kLeastSigma && std::isfinite(color_sigma) && depth_sigma_m >= kLeastSigma &&
        std::isfinite(depth_sigma_m))) {
    return Error{Errc::invalid_argument, "the deviations of the guided filter must be finite and at least 0.0001", {}};
  }
  return {};
}

GuidedFilter::GuidedFilter(GuidedFilterConfig config) : config_{config}, memory_{std::make_unique<Memory>()} {
  SACCADE_EXPECTS(config.validate().ok());
  memory_->disc = guided::make_disc(config.radius_px);
}
GuidedFilter::~GuidedFilter() = default;
GuidedFilter::GuidedFilter(GuidedFilter&&) noexcept = default;
GuidedFilter& GuidedFilter::operator=(GuidedFilter&&) noexcept = default;

void GuidedFilter::apply(int width, int height, std::span<const float> depth_m,
                         std::span<const Eigen::Vector4f> guidance, std::span<const std::uint8_t> used,
                         const Executor& executor, std::span<float> enhanced_m) {
  SACCADE_EXPECTS(width >= 0 && height >= 0);
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  SACCADE_EXPECTS(depth_m.size() == pixels && guidance.size() == pixels && used.size() == pixels &&
                  enhanced_m.size() == pixels);
  if (pixels == 0) return;
  if (memory_->shape.width != width) {
    memory_->idle.clear();
    memory_->shape = shape_of(width);
  }
  const guided::Variances variances{config_.color_sigma * config_.color_sigma,
                                    config_.depth_sigma_m * config_.depth_sigma_m};
  const Images images{height, memory_->shape, depth_m.data(), guidance.front().data(), used.data(), enhanced_m.data()};
  for (const auto& filter : memory_->idle) filter->forget();
  executor.parallel_for(static_cast<std::size_t>(height), kGuidedRowsPerTask, [&](std::size_t begin, std::size_t end) {
    std::unique_ptr<guided::RowFilter> filter = memory_->take(static_cast<int>(begin));
    filter->run(images, variances, static_cast<int>(begin), static_cast<int>(end));
    memory_->give_back(std::move(filter));
  });
}

}  // namespace saccade
