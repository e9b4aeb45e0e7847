// SPDX-License-Identifier: Apache-2.0
#include "lens.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "saccade/sensor/distortion.hpp"

namespace saccade::ros1 {
namespace {

/// Throws for a model that Brown's does not cover.
Distortion distortion_of(const CalibratedCamera& camera) {
  const std::vector<double>& D = camera.D;
  if (std::any_of(D.begin(), D.end(), [](double d) { return !std::isfinite(d); })) {
    throw std::runtime_error{"camera_info has a coefficient of distortion that is not a number"};
  }
  const bool is_zero = std::all_of(D.begin(), D.end(), [](double d) { return d == 0.0; });
  const auto lens = Distortion::from_coefficients(D);
  if (!is_zero && (!lens || (camera.model != "plumb_bob" && camera.model != "rational_polynomial"))) {
    throw std::runtime_error{"camera_info has the distortion model '" + camera.model + "' with " +
                             std::to_string(D.size()) +
                             " coefficients; plumb_bob and rational_polynomial with up to 8 are understood; name the "
                             "rectified topic (image_rect), as image_proc makes it"};
  }
  return is_zero ? Distortion{} : *lens;
}

}  // namespace

struct Lens::Map {
  Undistorter undistorter;
};

Lens::Lens(const CalibratedCamera& camera, bool rectified) : width_{camera.width}, height_{camera.height} {
  const bool by_p = rectified && camera.P[0] != 0.0;
  fx_ = by_p ? camera.P[0] : camera.K[0];
  fy_ = by_p ? camera.P[5] : camera.K[4];
  cx_ = by_p ? camera.P[2] : camera.K[2];
  cy_ = by_p ? camera.P[6] : camera.K[5];
  const bool finite = std::isfinite(fx_) && std::isfinite(fy_) && std::isfinite(cx_) && std::isfinite(cy_);
  if (!finite || !(fx_ > 0.0) || !(fy_ > 0.0)) {
    throw std::runtime_error{"camera_info says a focal length of " + std::to_string(fx_) + ", " + std::to_string(fy_) +
                             " pixels and a centre of " + std::to_string(cx_) + ", " + std::to_string(cy_) +
                             ": the camera is not calibrated"};
  }
  if (rectified) return;
  const Distortion distortion = distortion_of(camera);
  if (distortion.is_zero()) return;
  PinholeCamera pinhole;
  pinhole.width = width_;
  pinhole.height = height_;
  pinhole.fx = fx_;
  pinhole.fy = fy_;
  pinhole.cx = cx_;
  pinhole.cy = cy_;
  auto map = Undistorter::create(pinhole, distortion);
  if (!map) throw std::runtime_error{"camera_info: " + map.error().to_string()};
  map_ = std::make_unique<Map>(Map{*std::move(map)});
}

Lens::~Lens() = default;

void Lens::undistort(std::vector<float>& depth) const {
  if (!map_) return;
  const auto made = map_->undistorter.undistort(DepthImage{width_, height_, std::move(depth)});
  if (!made) throw std::runtime_error{made.error().to_string()};
  depth = made->pixels();
}

void Lens::undistort(std::string& rgb) const {
  if (!map_) return;
  ColorImage raw{width_, height_};
  std::memcpy(raw.data(), rgb.data(), std::min(rgb.size(), 3 * raw.size()));
  const auto made = map_->undistorter.undistort(raw);
  if (!made) throw std::runtime_error{made.error().to_string()};
  std::memcpy(rgb.data(), made->data(), 3 * made->size());
}

}  // namespace saccade::ros1
