// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <unordered_map>
#include <utility>

#include "saccade/io/clouds/internal/mesh_text.hpp"
#include "saccade/io/files/text_scan.hpp"

namespace saccade {
namespace {

constexpr std::size_t kHeaderBytes{84};  // 80 of text, 4 of the number of triangles
constexpr std::size_t kFacetBytes{50};   // normal and three corners of three floats, and two spare bytes

/// Mesh under construction, whose vertices with the same coordinates are one.
class SharedVertices {
 public:
  void reserve(std::size_t triangles) {
    mesh_.triangles.reserve(triangles);
    mesh_.vertices.reserve(triangles / 2);
    places_.reserve(triangles / 2);
  }
  void add(const std::array<Eigen::Vector3f, 3>& corners) {
    mesh_.triangles.push_back({place(corners[0]), place(corners[1]), place(corners[2])});
  }
  [[nodiscard]] TriangleMesh take() { return std::move(mesh_); }

 private:
  using Bits = std::array<std::uint32_t, 3>;
  struct Hash {
    std::size_t operator()(const Bits& bits) const {
      std::uint64_t hash{0};
      for (const std::uint32_t word : bits) hash = (hash ^ word) * 0x9E3779B97F4A7C15ULL;
      return hash ^ (hash >> 32U);
    }
  };
  [[nodiscard]] std::uint32_t place(const Eigen::Vector3f& vertex) {
    const Eigen::Vector3f v = vertex + Eigen::Vector3f::Zero();  // -0 is 0
    const auto next = static_cast<std::uint32_t>(mesh_.vertices.size());
    const auto [at, is_new] = places_.try_emplace(
        {std::bit_cast<std::uint32_t>(v.x()), std::bit_cast<std::uint32_t>(v.y()), std::bit_cast<std::uint32_t>(v.z())},
        next);
    if (is_new) mesh_.vertices.push_back(v);
    return at->second;
  }

  TriangleMesh mesh_;
  std::unordered_map<Bits, std::uint32_t, Hash> places_;
};

Error no_triangles() { return {Errc::corrupt_data, "the file has no triangles", {}}; }

std::size_t stated_triangles(std::string_view file) {
  std::uint32_t count{0};
  std::memcpy(&count, file.data() + kHeaderBytes - sizeof(count), sizeof(count));
  return count;
}

Result<TriangleMesh> parse_binary(std::string_view file) {
  if (file.size() < kHeaderBytes) {
    return Error{Errc::corrupt_data,
                 "neither a text that begins with \"solid\" nor long enough for a binary STL (" +
                     std::to_string(file.size()) + " bytes)",
                 {}};
  }
  const std::size_t count = stated_triangles(file);
  if ((file.size() - kHeaderBytes) / kFacetBytes < count) {
    return Error{Errc::corrupt_data,
                 "a binary STL that states " + std::to_string(count) + " triangles, but the file ends after " +
                     std::to_string((file.size() - kHeaderBytes) / kFacetBytes),
                 {}};
  }
  if (count == 0) return no_triangles();
  SharedVertices mesh;
  mesh.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::array<float, 9> values{};
    std::memcpy(values.data(), file.data() + kHeaderBytes + i * kFacetBytes + 3 * sizeof(float), sizeof(values));
    std::array<Eigen::Vector3f, 3> corners;
    for (std::size_t c = 0; c < 3; ++c) corners[c] = {values[3 * c], values[3 * c + 1], values[3 * c + 2]};
    if (!corners[0].allFinite() || !corners[1].allFinite() || !corners[2].allFinite()) {
      return Error{Errc::corrupt_data, "triangle " + std::to_string(i) + " has a coordinate that is not finite", {}};
    }
    mesh.add(corners);
  }
  return mesh.take();
}

std::string lower(std::string_view word) {
  std::string text{word};
  for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return text;
}

/// Reader of one line after another of an STL as text.
class StlLines {
 public:
  /// @return what is wrong with the line; empty: nothing.
  [[nodiscard]] std::string add(std::string_view line) {
    TokenScanner tokens{line, kBlanks};
    const auto first = tokens.next();
    if (!first) return {};
    std::string word = lower(*first);
    if (word == "end") word += lower(tokens.next().value_or(""));  // "end facet", as some programs write it
    if (word == "vertex") return add_vertex(tokens);
    if (word == "endloop") return end_loop();
    if (word == "solid") return open("solid", in_solid_);
    if (word == "endsolid") return close("endsolid", in_solid_);
    if (word == "facet" || word == "outer" || word == "endfacet" || word == "color") return {};
    return in_quotes(*first) + " is no word of an STL";
  }
  [[nodiscard]] bool is_complete() const { return !in_solid_ && corners_ == 0; }
  [[nodiscard]] TriangleMesh take() { return mesh_.take(); }

 private:
  [[nodiscard]] std::string add_vertex(TokenScanner& tokens) {
    if (corners_ == loop_.size()) return "a loop of more than three vertices";
    for (int axis = 0; axis < 3; ++axis) {
      const auto token = tokens.next();
      const auto value = token ? parse_number<float>(*token) : std::nullopt;
      if (!value || !std::isfinite(*value)) return "a vertex is three finite numbers";
      loop_[corners_][axis] = *value;
    }
    ++corners_;
    return {};
  }
  [[nodiscard]] std::string end_loop() {
    if (corners_ != loop_.size()) return "a loop of " + std::to_string(corners_) + " vertices, not three";
    mesh_.add(loop_);
    corners_ = 0;
    return {};
  }
  [[nodiscard]] static std::string open(const char* word, bool& is_open) {
    if (is_open) return std::string{"\""} + word + "\" within a solid";
    is_open = true;
    return {};
  }
  [[nodiscard]] static std::string close(const char* word, bool& is_open) {
    if (!is_open) return std::string{"\""} + word + "\" without a solid";
    is_open = false;
    return {};
  }

  SharedVertices mesh_;
  std::array<Eigen::Vector3f, 3> loop_;
  std::size_t corners_{0};
  bool in_solid_{false};
};

Result<TriangleMesh> parse_text(std::string_view file) {
  StlLines reader;
  LineScanner lines{file};
  while (const auto line = lines.next()) {
    if (const std::string wrong = reader.add(*line); !wrong.empty()) return bad_line(lines.line(), wrong);
  }
  if (!reader.is_complete()) return bad_line(lines.line(), "the file ends before \"endsolid\"");
  TriangleMesh mesh = reader.take();
  if (mesh.triangles.empty()) return no_triangles();
  return mesh;
}

}  // namespace

Result<TriangleMesh> parse_stl(std::string_view file) {
  const bool sized_as_binary =
      file.size() >= kHeaderBytes && file.size() == kHeaderBytes + stated_triangles(file) * kFacetBytes;
  const std::string_view text = file.substr(std::min(file.find_first_not_of(" \t\r\n"), file.size()));
  constexpr std::size_t kWord{5};
  if (!sized_as_binary && lower(text.substr(0, kWord)) == "solid") return parse_text(file);
  return parse_binary(file);
}

}  // namespace saccade
