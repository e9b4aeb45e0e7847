// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "saccade/io/clouds/internal/mesh_text.hpp"
#include "saccade/io/clouds/internal/split_polygon.hpp"
#include "saccade/io/files/text_scan.hpp"

namespace saccade {
namespace {

/// Reader of one statement after another.
class ObjStatements {
 public:
  /// @return what is wrong with the statement; empty: nothing.
  [[nodiscard]] std::string add(std::string_view statement) {
    TokenScanner tokens{statement.substr(0, statement.find('#')), kBlanks};
    const auto word = tokens.next();
    if (!word) return {};
    if (*word == "v") return add_vertex(tokens);
    if (*word == "f" || *word == "fo") return add_face(tokens);
    constexpr std::array kFreeForm{"curv", "curv2", "surf", "cstype"};
    free_form_ = free_form_ || std::find(kFreeForm.begin(), kFreeForm.end(), *word) != kFreeForm.end();
    return {};
  }
  [[nodiscard]] bool has_free_form() const { return free_form_; }
  [[nodiscard]] TriangleMesh take() {
    if (mesh_.colors.size() != mesh_.vertices.size()) mesh_.colors.clear();
    return std::move(mesh_);
  }

 private:
  [[nodiscard]] std::string add_vertex(TokenScanner& tokens) {
    std::array<float, 7> values{};  // x y z, x y z w, x y z r g b or x y z w r g b
    std::size_t count{0};
    while (const auto token = tokens.next()) {
      const auto value = parse_number<float>(*token);
      if (!value || !std::isfinite(*value)) return in_quotes(*token) + " is not a finite number";
      if (count == values.size()) return "a vertex of more than seven numbers";
      values[count++] = *value;
    }
    if (count < 3) return "a vertex of fewer than three numbers";
    mesh_.vertices.emplace_back(values[0], values[1], values[2]);
    if (count >= 6) mesh_.colors.push_back(color_of(std::span{values}.subspan(count - 3, 3)));
    return {};
  }
  [[nodiscard]] static Rgb8 color_of(std::span<const float> rgb) {
    constexpr float kMost{255.0F};
    const auto byte = [](float v) { return static_cast<std::uint8_t>(std::lround(std::clamp(v, 0.0F, 1.0F) * kMost)); };
    return {byte(rgb[0]), byte(rgb[1]), byte(rgb[2])};
  }
  [[nodiscard]] std::string add_face(TokenScanner& tokens) {
    corners_.clear();
    while (const auto token = tokens.next()) {
      const auto index = parse_integer<std::int64_t>(token->substr(0, token->find('/')));
      const auto vertices = static_cast<std::int64_t>(mesh_.vertices.size());
      const std::int64_t corner = !index ? -1 : *index < 0 ? vertices + *index : *index - 1;
      if (!index) return in_quotes(*token) + " is no vertex of a face";
      if (corner < 0 || corner >= vertices) {
        return "the face names vertex " + std::to_string(*index) + ", and " + std::to_string(vertices) +
               " stand before it";
      }
      corners_.push_back(static_cast<std::uint32_t>(corner));
    }
    if (split_polygon(mesh_.vertices, corners_, mesh_.triangles)) return {};
    return "a face of " + std::to_string(corners_.size()) + " corners that is not convex; split it into triangles";
  }

  TriangleMesh mesh_;
  std::vector<std::uint32_t> corners_;
  bool free_form_{false};
};

}  // namespace

Result<TriangleMesh> parse_obj(std::string_view file) {
  ObjStatements reader;
  LineScanner lines{without_byte_order_mark(file)};
  std::string joined;  // lines that end in a backslash, and the next one
  while (const auto line = lines.next()) {
    std::string_view statement = *line;
    const bool goes_on = statement.ends_with('\\');
    if (goes_on || !joined.empty()) {
      joined += statement.substr(0, statement.size() - (goes_on ? 1 : 0));
      joined += ' ';
      if (goes_on) continue;
      statement = joined;
    }
    if (const std::string wrong = reader.add(statement); !wrong.empty()) return bad_line(lines.line(), wrong);
    joined.clear();
  }
  if (const std::string wrong = reader.add(joined); !wrong.empty()) return bad_line(lines.line(), wrong);
  if (reader.has_free_form()) {
    return Error{Errc::unsupported, "free-form curves and surfaces; save the model as triangles", {}};
  }
  TriangleMesh mesh = reader.take();
  if (mesh.triangles.empty()) return Error{Errc::corrupt_data, "the file has no triangles", {}};
  return mesh;
}

}  // namespace saccade
