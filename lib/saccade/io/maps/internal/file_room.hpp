// SPDX-License-Identifier: Apache-2.0
#pragma once
// FileRoom: which stretches of a file are free.

#include <cstdint>
#include <map>
#include <set>
#include <utility>

namespace saccade {

/// Room of a file that grows at its end. Free stretches that touch are joined; the smallest that suffices is used next.
/// O(log stretches). One thread.
class FileRoom {
 public:
  /// Returns the offset of a stretch of `bytes`, rounded up to whole blocks.
  [[nodiscard]] std::uint64_t take(std::uint64_t bytes) {
    const std::uint64_t size = whole_blocks(bytes);
    const auto fitting = by_size_.lower_bound({size, 0});
    if (fitting == by_size_.end()) {
      const std::uint64_t offset = end_;
      end_ += size;
      return offset;
    }
    const auto [free_size, offset] = *fitting;
    remove(by_offset_.find(offset));
    if (free_size > size) insert(offset + size, free_size - size);
    return offset;
  }
  /// Frees a stretch that was taken.
  void give_back(std::uint64_t offset, std::uint64_t bytes) {
    std::uint64_t size = whole_blocks(bytes);
    const auto next = by_offset_.lower_bound(offset);
    if (next != by_offset_.end() && next->first == offset + size) {
      size += next->second;
      remove(next);
    }
    const auto after = by_offset_.lower_bound(offset);
    if (after != by_offset_.begin()) {
      const auto before = std::prev(after);
      if (before->first + before->second == offset) {
        offset = before->first;
        size += before->second;
        remove(before);
      }
    }
    if (offset + size == end_) {
      end_ = offset;
    } else {
      insert(offset, size);
    }
  }
  /// Returns the end of the last stretch in use.
  [[nodiscard]] std::uint64_t end() const { return end_; }

 private:
  using ByOffset = std::map<std::uint64_t, std::uint64_t>;
  static constexpr std::uint64_t kBlock{256};
  static std::uint64_t whole_blocks(std::uint64_t bytes) { return (bytes + kBlock - 1) / kBlock * kBlock; }
  void insert(std::uint64_t offset, std::uint64_t size) {
    by_offset_.emplace(offset, size);
    by_size_.emplace(size, offset);
  }
  void remove(ByOffset::iterator it) {
    by_size_.erase({it->second, it->first});
    by_offset_.erase(it);
  }

  ByOffset by_offset_;                                         ///< size of the free stretch at an offset
  std::set<std::pair<std::uint64_t, std::uint64_t>> by_size_;  ///< (size, offset)
  std::uint64_t end_{0};
};

}  // namespace saccade
