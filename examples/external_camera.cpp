// SPDX-License-Identifier: Apache-2.0
// A camera for Saccade (docs/guides/processes.md), in C++ with nothing but the standard library. It sees a ball on a
// plane, in depth and colour; put your own camera in its place.
//
// To make it yours: open the camera at the start of main, say what it is in kHello, and take a frame in capture().
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

namespace {

constexpr int kWidth{160};
constexpr int kHeight{120};
constexpr double kFocal_px{131.25};
constexpr double kMaxRange_m{3.0};
constexpr const char* kHello{
    R"({"saccade": 1, "width": 160, "height": 120, "fx": 131.25, "fy": 131.25, "cx": 79.5, "cy": 59.5, )"
    R"("min_range_m": 0.1, "max_range_m": 3.0, "depth": "uint16_mm", "color": "rgb8"})"};

using Vector = std::array<double, 3>;
using Matrix = std::array<double, 16>;  // row by row

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

struct Hit {
  double depth_m{0.0};  // 0: nothing
  std::array<unsigned char, 3> rgb{};
};

/// The nearest surface along a ray of length 1 along the camera's z: a plane z = 0 and a ball of 10 cm radius on it.
Hit cast(const Vector& origin, const Vector& ray) {
  Hit hit{kMaxRange_m, {}};
  if (ray[2] < 0.0 && origin[2] > 0.0 && -origin[2] / ray[2] < hit.depth_m) {
    hit = {-origin[2] / ray[2], {160, 160, 150}};
  }
  const Vector to_ball{-origin[0], -origin[1], 0.1 - origin[2]};
  const double a = dot(ray, ray);
  const double b = dot(ray, to_ball);
  const double under_root = b * b - a * (dot(to_ball, to_ball) - 0.1 * 0.1);
  if (under_root > 0.0 && b > std::sqrt(under_root) && (b - std::sqrt(under_root)) / a < hit.depth_m) {
    hit = {(b - std::sqrt(under_root)) / a, {200, 60, 40}};
  }
  return hit.depth_m < kMaxRange_m ? hit : Hit{};
}

/// Depth in millimetres, 16 bits each, low byte first; then red, green and blue of each pixel.
std::string capture(const Matrix& T_world_camera) {
  const Matrix& T = T_world_camera;
  std::string depth;
  std::string color;
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      const Vector p{(u - 79.5) / kFocal_px, (v - 59.5) / kFocal_px, 1.0};
      const Vector ray{dot({T[0], T[1], T[2]}, p), dot({T[4], T[5], T[6]}, p), dot({T[8], T[9], T[10]}, p)};
      const Hit hit = cast({T[3], T[7], T[11]}, ray);
      const auto depth_mm = static_cast<std::uint16_t>(std::lround(hit.depth_m * 1000.0));
      depth += static_cast<char>(depth_mm & 0xFF);
      depth += static_cast<char>(depth_mm >> 8);
      for (const unsigned char channel : hit.rgb) color += static_cast<char>(channel);
    }
  }
  return depth + color;
}

/// The numbers of a request from a key on; enough of JSON for requests, which have no text after their numbers.
std::vector<double> numbers_after(const std::string& request, const std::string& key) {
  std::vector<double> numbers;
  std::size_t at = request.find('"' + key + '"');
  if (at == std::string::npos) return numbers;
  at += key.size() + 2;
  while ((at = request.find_first_of("-0123456789\"", at)) != std::string::npos && request[at] != '"') {
    char* end = nullptr;
    const double number = std::strtod(request.c_str() + at, &end);
    if (end == request.c_str() + at) break;
    numbers.push_back(number);
    at = static_cast<std::size_t>(end - request.c_str());
  }
  return numbers;
}

bool asks_for(const std::string& request, const std::string& what) {
  return request.find('"' + what + '"') != std::string::npos;
}

}  // namespace

int main() {
  for (std::string request; std::getline(std::cin, request);) {  // ends when Saccade is done
    const std::vector<double> number = numbers_after(request, "number");
    const std::vector<double> pose = numbers_after(request, "T_world_camera");
    if (asks_for(request, "hello")) {
      std::cout << kHello << std::endl;
    } else if (asks_for(request, "capture") && number.size() == 1 && pose.size() == 16) {
      Matrix T_world_camera{};
      for (std::size_t i = 0; i < 16; ++i) T_world_camera[i] = pose[i];
      const std::string frame = capture(T_world_camera);
      std::cout << R"({"number": )" << static_cast<long>(number[0]) << R"(, "bytes": )" << frame.size() << "}\n"
                << frame << std::flush;
    } else {
      std::cout << R"({"error": "unknown request"})" << std::endl;
    }
  }
}
