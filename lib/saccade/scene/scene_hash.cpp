// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/scene_hash.hpp"

#include <bit>
#include <cstdint>

namespace saccade {
namespace {

class Fnv1a {
 public:
  void add(std::uint64_t value) {
    for (unsigned shift = 0; shift < 64; shift += 8) {
      state_ = (state_ ^ ((value >> shift) & 0xffU)) * 0x100000001b3ULL;
    }
  }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value == 0.0 ? 0.0 : value)); }  // −0 is 0
  template <class Derived>
  void add_all(const Eigen::MatrixBase<Derived>& values) {
    for (Eigen::Index j = 0; j < values.cols(); ++j) {
      for (Eigen::Index i = 0; i < values.rows(); ++i) add(static_cast<double>(values(i, j)));
    }
  }
  [[nodiscard]] std::uint64_t value() const { return state_; }

 private:
  std::uint64_t state_{0xcbf29ce484222325ULL};
};

void add(Fnv1a& hash, const Sphere& sphere) {
  hash.add_all(sphere.center);
  hash.add(sphere.radius_m);
}

void add(Fnv1a& hash, const Box& box) {
  hash.add_all(box.min);
  hash.add_all(box.max);
}

void add(Fnv1a& hash, const Cylinder& cylinder) {
  hash.add_all(cylinder.base);
  hash.add_all(cylinder.top);
  hash.add(cylinder.radius_m);
}

}  // namespace

std::string scene_hash(const RayScene& scene) {
  Fnv1a hash;
  for (const SceneObject& object : scene.scene().objects) hash.add(std::uint64_t{object.fixture ? 1U : 0U});
  for (const ObjectMesh& object : scene.meshes()) {
    hash.add(std::uint64_t{object.support ? 1U : 0U});
    hash.add(std::uint64_t{object.mesh.vertices.size()});
    for (const Eigen::Vector3f& vertex : object.mesh.vertices) hash.add_all(vertex);
    hash.add(std::uint64_t{object.mesh.triangles.size()});
    for (const auto& triangle : object.mesh.triangles) {
      for (const std::uint32_t corner : triangle) hash.add(std::uint64_t{corner});
    }
  }
  add(hash, scene.scene().workspace);
  for (const Region& region : scene.scene().regions) {
    hash.add(std::uint64_t{region.index()});
    std::visit([&hash](const auto& shape) { add(hash, shape); }, region);
  }
  for (const Pose& T_world_camera : scene.scene().scan) hash.add_all(T_world_camera.matrix());

  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (int shift = 60; shift >= 0; shift -= 4) text += kDigits[(hash.value() >> static_cast<unsigned>(shift)) & 0xfU];
  return text;
}

}  // namespace saccade
