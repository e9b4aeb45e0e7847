// SPDX-License-Identifier: Apache-2.0
#include "saccade/surfel/guided_filter.hpp"

#include <hwy/aligned_allocator.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <mutex>
#include <utility>
#include <vector>

#include "saccade/surfel/guided_filter_kernels.hpp"

namespace saccade {
namespace {

constexpr double kLeastSigma{1e-4};
constexpr int kLeastRows{32};  // of a task: each fits 2R rows more, which its neighbours fit too

template <class T>
hwy::AlignedFreeUniquePtr<T[]> zeros(std::size_t count) {
  auto made = hwy::AllocateAligned<T>(std::max<std::size_t>(count, 1));
  if (made == nullptr) throw std::bad_alloc{};
  std::fill_n(made.get(), count, T{0});
  return made;
}

/// The images of one call.
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

/// Runs the filter down some rows of an image: loads each row, fits the one R above it, and enhances the one R above
/// that. The last 2R + 1 loaded rows and rows of fits are kept.
class RowFilter {
 public:
  RowFilter(const guided::RowShape& shape, const guided::Disc& disc)
      : disc_{disc},
        shape_{shape},
        kept_{2 * disc.radius_px + 1},
        rows_{zeros<float>(static_cast<std::size_t>(kept_) * guided::kChannels * shape.stride)},
        fits_{zeros<double>(static_cast<std::size_t>(kept_) * guided::kFits * shape.stride)},
        sums_{zeros<double>(guided::sums_of(disc))},
        enhanced_{zeros<float>(shape.stride)},
        row_window_(static_cast<std::size_t>(kept_)),
        fit_window_(static_cast<std::size_t>(kept_)) {}

  /// Rows [begin, end) of the output.
  void run(const Images& images, const guided::Variances& variances, int begin, int end) {
    const int radius = disc_.radius_px;
    for (int v = begin - 2 * radius; v < end + 2 * radius; ++v) {
      load(images, v);
      if (v >= begin) fit(images.height, v - radius, variances);
      if (v >= begin + 2 * radius) enhance(images, v - 2 * radius);
    }
  }

 private:
  [[nodiscard]] std::size_t slot(int v) const { return static_cast<std::size_t>((v + kept_) % kept_); }
  [[nodiscard]] float* row(int v) const { return rows_.get() + slot(v) * guided::kChannels * shape_.stride; }
  [[nodiscard]] double* fits(int v) const { return fits_.get() + slot(v) * guided::kFits * shape_.stride; }

  /// Rows outside the image have no pixel that is used.
  void load(const Images& images, int v) {
    if (v < 0 || v >= images.height) {
      std::fill_n(row(v), guided::kChannels * shape_.stride, 0.0F);
      return;
    }
    const std::size_t first = static_cast<std::size_t>(v) * static_cast<std::size_t>(shape_.width);
    guided::load_row(shape_, images.depth_m + first, images.guidance + 4 * first, images.used + first, row(v));
  }

  void fit(int height, int v, const guided::Variances& variances) {
    if (v < 0 || v >= height) {
      std::fill_n(fits(v), guided::kFits * shape_.stride, 0.0);
      return;
    }
    for (int i = 0; i < kept_; ++i) row_window_[static_cast<std::size_t>(i)] = row(v - disc_.radius_px + i);
    guided::fit_row(shape_, disc_, variances, row_window_.data(), sums_.get(), fits(v));
  }

  void enhance(const Images& images, int v) {
    for (int i = 0; i < kept_; ++i) fit_window_[static_cast<std::size_t>(i)] = fits(v - disc_.radius_px + i);
    guided::enhance_row(shape_, disc_, row(v), fit_window_.data(), sums_.get(), enhanced_.get());
    const std::size_t first = static_cast<std::size_t>(v) * static_cast<std::size_t>(shape_.width);
    for (std::size_t u = 0; u < static_cast<std::size_t>(shape_.width); ++u) {
      images.enhanced_m[first + u] = images.used[first + u] != 0 ? enhanced_[u] : images.depth_m[first + u];
    }
  }

  guided::Disc disc_;
  guided::RowShape shape_;
  int kept_;
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

/// Row filters for images of one width: as many as have run at once.
struct GuidedFilter::Memory {
  guided::Disc disc;
  guided::RowShape shape;
  std::mutex mutex;
  std::vector<std::unique_ptr<guided::RowFilter>> idle;

  std::unique_ptr<guided::RowFilter> take() {
    {
      const std::lock_guard lock{mutex};
      if (!idle.empty()) {
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
  const std::size_t rows = static_cast<std::size_t>(height);
  const std::size_t tasks = executor.threads() == 1 ? 1 : 4 * executor.threads();
  const std::size_t grain = std::max<std::size_t>(kLeastRows, (rows + tasks - 1) / tasks);
  executor.parallel_for(rows, grain, [&](std::size_t begin, std::size_t end) {
    std::unique_ptr<guided::RowFilter> filter = memory_->take();
    filter->run(images, variances, static_cast<int>(begin), static_cast<int>(end));
    memory_->give_back(std::move(filter));
  });
}

}  // namespace saccade
