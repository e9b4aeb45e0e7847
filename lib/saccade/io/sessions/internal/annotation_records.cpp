// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/sessions/internal/annotation_records.hpp"

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/little_endian.hpp"

namespace saccade {
namespace {

// The order in AnnotationChange is the order of the numbers in files.
constexpr std::size_t kKinds{std::variant_size_v<AnnotationChange>};
static_assert(kKinds == 10);

using Bytes = std::vector<std::byte>;

void append_count(Bytes& out, std::size_t count) { append_value(out, static_cast<std::uint32_t>(count)); }

void append_points(Bytes& out, const std::vector<std::uint32_t>& points) {
  append_count(out, points.size());
  const auto bytes = std::as_bytes(std::span{points});
  out.insert(out.end(), bytes.begin(), bytes.end());
}

void append_text(Bytes& out, std::string_view text) {
  append_count(out, text.size());
  const auto bytes = as_byte_span(text);
  out.insert(out.end(), bytes.begin(), bytes.end());
}

struct Writer {
  Bytes& out;

  void operator()(const SetControlPoints& set) const {
    append_value(out, set.label);
    append_value(out, set.start_cost);
    append_points(out, set.points);
  }
  void operator()(const RemoveControlPoints& remove) const { append_points(out, remove.points); }
  void operator()(const MoveControlPoint& move) const {
    append_value(out, move.from);
    append_value(out, move.to);
  }
  void operator()(const PaintPoints& paint) const {
    append_value(out, paint.label);
    append_points(out, paint.points);
  }
  void operator()(const DefineLabels& define) const {
    append_count(out, define.labels.size());
    for (const NumberedLabel& label : define.labels) {
      append_value(out, label.number);
      append_value(out, label.info.color);
      append_value(out, label.info.instance);
      append_text(out, label.info.name);
      append_text(out, label.info.class_name);
    }
  }
  void operator()(const ClearAnnotation& /*clear*/) const {}
  void operator()(const LockLabel& lock) const {
    append_value(out, lock.label);
    append_value(out, static_cast<std::uint8_t>(lock.locked ? 1 : 0));
    append_points(out, lock.points);
  }
  void operator()(const PaintLabels& paint) const {
    append_points(out, paint.points);
    append_points(out, paint.labels);
  }
  void operator()(const UndoAction& /*undo*/) const {}
  void operator()(const RedoAction& /*redo*/) const {}
};

/// Reader that becomes zero or empty after the first missing value.
class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : bytes_{bytes} {}

  [[nodiscard]] bool complete() const { return !short_ && bytes_.left() == 0; }
  [[nodiscard]] bool is_short() const { return short_; }

  template <class T>
  T value() {
    if (!has(sizeof(T))) return T{};
    return bytes_.value<T>();
  }
  std::vector<std::uint32_t> points() {
    const std::size_t count = value<std::uint32_t>();
    if (!has(sizeof(std::uint32_t) * count)) return {};
    std::vector<std::uint32_t> points(count);
    const auto raw = bytes_.take(sizeof(std::uint32_t) * count);
    if (count > 0) std::memcpy(points.data(), raw.data(), raw.size());
    return points;
  }
  std::string text() {
    const std::size_t count = value<std::uint32_t>();
    return has(count) ? std::string{as_text(bytes_.take(count))} : std::string{};
  }

 private:
  bool has(std::size_t count) {
    short_ = short_ || !bytes_.has(count);
    return !short_;
  }
  ByteReader bytes_;
  bool short_{false};
};

void read(Reader& in, SetControlPoints& set) {
  set.label = in.value<std::uint32_t>();
  set.start_cost = in.value<double>();
  set.points = in.points();
}
void read(Reader& in, RemoveControlPoints& remove) { remove.points = in.points(); }
void read(Reader& in, MoveControlPoint& move) {
  move.from = in.value<std::uint32_t>();
  move.to = in.value<std::uint32_t>();
}
void read(Reader& in, PaintPoints& paint) {
  paint.label = in.value<std::uint32_t>();
  paint.points = in.points();
}
void read(Reader& in, DefineLabels& define) {
  const auto count = in.value<std::uint32_t>();
  for (std::uint32_t i = 0; i < count && !in.is_short(); ++i) {
    NumberedLabel label;
    label.number = in.value<std::uint32_t>();
    label.info.color = in.value<std::array<std::uint8_t, 3>>();
    label.info.instance = in.value<std::uint32_t>();
    label.info.name = in.text();
    label.info.class_name = in.text();
    define.labels.push_back(std::move(label));
  }
}
void read(Reader& /*in*/, ClearAnnotation& /*clear*/) {}
void read(Reader& in, LockLabel& lock) {
  lock.label = in.value<std::uint32_t>();
  lock.locked = in.value<std::uint8_t>() != 0;
  lock.points = in.points();
}
void read(Reader& in, PaintLabels& paint) {
  paint.points = in.points();
  paint.labels = in.points();
}
void read(Reader& /*in*/, UndoAction& /*undo*/) {}
void read(Reader& /*in*/, RedoAction& /*redo*/) {}

template <std::size_t... I>
std::optional<AnnotationChange> change_of_kind(std::size_t kind, std::index_sequence<I...> /*kinds*/) {
  std::optional<AnnotationChange> change;
  static_cast<void>(((kind == I && (change.emplace(std::in_place_index<I>), true)) || ...));
  return change;
}

}  // namespace

void append_action(const AnnotationAction& action, std::vector<std::byte>& out) {
  append_value(out, action.client);
  append_value(out, static_cast<std::uint8_t>(action.change.index()));
  std::visit(Writer{out}, action.change);
}

Result<AnnotationAction> read_action(std::span<const std::byte> bytes) {
  Reader in{bytes};
  const auto client = in.value<std::uint64_t>();
  std::optional<AnnotationChange> change = change_of_kind(in.value<std::uint8_t>(), std::make_index_sequence<kKinds>{});
  if (!change) return Error{Errc::corrupt_data, "an action of an unknown kind", {}};
  std::visit([&](auto& kind) { read(in, kind); }, *change);
  if (!in.complete()) return Error{Errc::corrupt_data, "an action of a wrong length", {}};
  return AnnotationAction{client, std::move(*change)};
}

}  // namespace saccade
