// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "saccade/io/clouds/internal/mesh_text.hpp"
#include "saccade/io/clouds/internal/split_polygon.hpp"
#include "saccade/io/files/text_scan.hpp"

namespace saccade {
namespace {

/// Lines without their comments, but for those that say nothing.
class OffLines {
 public:
  explicit OffLines(std::string_view file) : lines_{without_byte_order_mark(file)} {}
  [[nodiscard]] std::optional<std::string_view> next() {
    while (const auto line = lines_.next()) {
      const std::string_view text = trimmed(line->substr(0, line->find('#')));
      if (!text.empty()) return text;
    }
    return std::nullopt;
  }
  [[nodiscard]] Error error(const std::string& what) const { return bad_line(lines_.line(), what); }

 private:
  LineScanner lines_;
};

struct Counts {
  std::size_t vertices{0};
  std::size_t faces{0};
};

/// Reads the header and the counts, which follow it on the same line or the next.
Result<Counts> read_counts(OffLines& lines) {
  auto line = lines.next();
  if (!line) return Error{Errc::corrupt_data, "the file is empty", {}};
  const std::size_t word = line->find("OFF");
  if (word != std::string_view::npos) {
    const std::string_view before = line->substr(0, word);
    if (before.find_first_of("4n") != std::string_view::npos) {
      return Error{Errc::unsupported, "an OFF of other than three dimensions", {}};
    }
    if (before.find_first_not_of("STCN") != std::string_view::npos) return lines.error("no header of an OFF");
    constexpr std::size_t kWord{3};
    const std::string_view rest = trimmed(line->substr(word + kWord));
    if (rest.starts_with("BINARY")) return Error{Errc::unsupported, "a binary OFF; save it as text", {}};
    line = rest.empty() ? lines.next() : rest;
    if (!line) return lines.error("the file ends before the numbers of vertices and faces");
  }
  TokenScanner tokens{*line, kBlanks};
  const auto count = [&] {
    const auto token = tokens.next();
    return token ? parse_integer<std::uint32_t>(*token) : std::nullopt;
  };
  const auto vertices = count();
  const auto faces = count();
  if (!vertices || !faces) return lines.error("the numbers of vertices and faces are missing");
  return Counts{*vertices, *faces};
}

Status read_vertices(OffLines& lines, std::size_t count, TriangleMesh& mesh) {
  for (std::size_t i = 0; i < count; ++i) {
    const auto line = lines.next();
    if (!line) {
      return lines.error("the file ends after " + std::to_string(i) + " of " + std::to_string(count) + " vertices");
    }
    TokenScanner tokens{*line, kBlanks};
    Eigen::Vector3f& vertex = mesh.vertices.emplace_back();
    for (int axis = 0; axis < 3; ++axis) {
      const auto token = tokens.next();
      const auto value = token ? parse_number<float>(*token) : std::nullopt;
      if (!value || !std::isfinite(*value)) return lines.error("a vertex begins with three finite numbers");
      vertex[axis] = *value;
    }
  }
  return {};
}

Status read_face(OffLines& lines, std::string_view line, std::vector<std::uint32_t>& corners, TriangleMesh& mesh) {
  TokenScanner tokens{line, kBlanks};
  const auto first = tokens.next();
  const auto count = first ? parse_integer<std::uint32_t>(*first) : std::nullopt;
  if (!count) return lines.error("a face begins with its number of corners");
  corners.clear();
  for (std::uint32_t i = 0; i < *count; ++i) {
    const auto token = tokens.next();
    const auto corner = token ? parse_integer<std::uint32_t>(*token) : std::nullopt;
    if (!corner) return lines.error("a face of " + std::to_string(*count) + " corners names " + std::to_string(i));
    if (*corner >= mesh.vertices.size()) {
      return lines.error("the face names vertex " + std::to_string(*corner) + " of " +
                         std::to_string(mesh.vertices.size()) + ", counted from 0");
    }
    corners.push_back(*corner);
  }
  if (split_polygon(mesh.vertices, corners, mesh.triangles)) return {};
  return lines.error("a face of " + std::to_string(*count) + " corners that is not convex; split it into triangles");
}

}  // namespace

Result<TriangleMesh> parse_off(std::string_view file) {
  OffLines lines{file};
  SACCADE_TRY(const Counts counts, read_counts(lines));
  TriangleMesh mesh;
  constexpr std::size_t kLeastVertexBytes{6};  // "0 0 0\n"
  mesh.vertices.reserve(std::min(counts.vertices, file.size() / kLeastVertexBytes));
  SACCADE_CHECK(read_vertices(lines, counts.vertices, mesh));
  std::vector<std::uint32_t> corners;
  for (std::size_t i = 0; i < counts.faces; ++i) {
    const auto line = lines.next();
    if (!line) {
      return lines.error("the file ends after " + std::to_string(i) + " of " + std::to_string(counts.faces) + " faces");
    }
    SACCADE_CHECK(read_face(lines, *line, corners, mesh));
  }
  if (lines.next()) return lines.error("lines follow the last of " + std::to_string(counts.faces) + " faces");
  if (mesh.triangles.empty()) return Error{Errc::corrupt_data, "the file has no triangles", {}};
  return mesh;
}

}  // namespace saccade
