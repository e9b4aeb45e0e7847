// SPDX-License-Identifier: Apache-2.0
#pragma once
// Mask512, Voxel, BrickRef (the four kinds of brick), Sector and SectorRef: the map's storage, shared copy-on-write.

#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <memory>
#include <utility>

#include "saccade/core/result.hpp"
#include "saccade/map/voxel_index.hpp"
#include "saccade/sensor/image.hpp"

namespace saccade {

/// One bit per voxel of a brick, or per brick of a sector; bit child_index(i). Word z holds slice z.
struct Mask512 {
  std::array<std::uint64_t, 8> words{};

  [[nodiscard]] static constexpr Mask512 all_set() {
    Mask512 m;
    m.words.fill(~std::uint64_t{0});
    return m;
  }
  [[nodiscard]] constexpr bool test(int i) const { return (words[static_cast<std::size_t>(i >> 6)] >> (i & 63)) & 1U; }
  constexpr void set(int i) { words[static_cast<std::size_t>(i >> 6)] |= std::uint64_t{1} << (i & 63); }
  constexpr void reset(int i) { words[static_cast<std::size_t>(i >> 6)] &= ~(std::uint64_t{1} << (i & 63)); }
  constexpr void assign(int i, bool value) { value ? set(i) : reset(i); }
  [[nodiscard]] constexpr bool any() const {
    std::uint64_t bits{0};
    for (const std::uint64_t word : words) bits |= word;
    return bits != 0;
  }
  [[nodiscard]] constexpr bool none() const { return !any(); }
  [[nodiscard]] constexpr bool all() const {
    std::uint64_t bits{~std::uint64_t{0}};
    for (const std::uint64_t word : words) bits &= word;
    return bits == ~std::uint64_t{0};
  }
  [[nodiscard]] constexpr int count() const {
    int n{0};
    for (const std::uint64_t word : words) n += std::popcount(word);
    return n;
  }
  /// Calls body(i) for the bits that are set, in order.
  template <class Body>
  void for_each(const Body& body) const {
    for (std::size_t z = 0; z < 8; ++z) {
      for (std::uint64_t rest = words[z]; rest != 0; rest &= rest - 1) {
        body(z * 64 + static_cast<std::size_t>(std::countr_zero(rest)));
      }
    }
  }
  /// Calls body(first, count) for the runs of bits that are set within a slice, in order.
  template <class Body>
  void for_each_run(const Body& body) const {
    for (std::size_t z = 0; z < 8; ++z) {
      for (std::uint64_t rest = words[z]; rest != 0;) {
        const int first = std::countr_zero(rest);
        const int count = std::countr_one(rest >> first);
        body(z * 64 + static_cast<std::size_t>(first), static_cast<std::size_t>(count));
        if (first + count == 64) break;
        rest &= ~std::uint64_t{0} << (first + count);
      }
    }
  }
  [[nodiscard]] constexpr Mask512 operator~() const {
    Mask512 m;
    for (std::size_t i = 0; i < 8; ++i) m.words[i] = ~words[i];
    return m;
  }
  [[nodiscard]] constexpr Mask512 operator|(const Mask512& o) const {
    Mask512 m;
    for (std::size_t i = 0; i < 8; ++i) m.words[i] = words[i] | o.words[i];
    return m;
  }
  [[nodiscard]] constexpr Mask512 operator&(const Mask512& o) const {
    Mask512 m;
    for (std::size_t i = 0; i < 8; ++i) m.words[i] = words[i] & o.words[i];
    return m;
  }
  [[nodiscard]] constexpr bool operator==(const Mask512&) const = default;
};

/// TSDF value of 1 in a voxel's fixed-point representation.
constexpr std::int16_t kTsdfOne{32767};

/// Content of a voxel: v in units of 1/32767, and the number of observations w. w = 0 implies v = 0.
struct Voxel {
  std::int16_t v{0};
  std::uint16_t w{0};
  [[nodiscard]] constexpr bool operator==(const Voxel&) const = default;
};

/// States of a voxel (thesis eq. 2.11).
enum class VoxelState : std::uint8_t { unknown, empty, occupied };

[[nodiscard]] constexpr VoxelState state_of(const Voxel& voxel) {
  if (voxel.w == 0) return VoxelState::unknown;
  return voxel.v <= 0 ? VoxelState::occupied : VoxelState::empty;
}

enum class BrickKind : std::uint8_t {
  unknown,        ///< no voxel was ever observed; takes no memory
  constant_free,  ///< every voxel has v = 1 and the same weight; takes no memory beyond its sector
  free,           ///< every voxel is unknown or has v = 1; 3-bit weights in bit planes
  dense,          ///< v and w of every voxel, perhaps colours
};

/// Brick in which every voxel is unknown, or has v = 1 and a weight ≤ 7. The weights' bits lie in three planes, so that
/// a few word operations count an observation of many voxels.
struct FreeBrick {
  std::array<Mask512, 3> weight_bits{};

  [[nodiscard]] Mask512 known() const { return weight_bits[0] | weight_bits[1] | weight_bits[2]; }
  [[nodiscard]] std::uint16_t weight(int i) const {
    return static_cast<std::uint16_t>((weight_bits[0].test(i) ? 1 : 0) | (weight_bits[1].test(i) ? 2 : 0) |
                                      (weight_bits[2].test(i) ? 4 : 0));
  }
  void set_weight(int i, std::uint16_t w) {
    for (std::size_t bit = 0; bit < 3; ++bit) weight_bits[bit].assign(i, ((w >> bit) & 1U) != 0);
  }
  /// Returns the voxels of a slice whose weight is at least `least` ≥ 1.
  [[nodiscard]] std::uint64_t weight_at_least(std::size_t slice, std::uint16_t least) const;
  /// Counts an observation: w ← min(w + 1, limit) for the voxels in `seen`; limit in [1, 7].
  void observe(const Mask512& seen, std::uint16_t limit);
  [[nodiscard]] static FreeBrick constant(std::uint16_t w);
  [[nodiscard]] bool operator==(const FreeBrick&) const = default;
};

using BrickColors = std::array<Rgb8, kBrickVoxels>;

/// Brick with v and w of every voxel, the two masks of eq. 2.11, and colours where any were fused.
struct DenseBrick {
  std::array<std::int16_t, kBrickVoxels> v{};
  std::array<std::uint16_t, kBrickVoxels> w{};
  Mask512 occupied;                     ///< w > 0 and v ≤ 0
  Mask512 unknown{Mask512::all_set()};  ///< w = 0
  std::unique_ptr<BrickColors> colors;

  DenseBrick() = default;
  DenseBrick(const DenseBrick& other);
  DenseBrick& operator=(const DenseBrick&) = delete;
  [[nodiscard]] bool operator==(const DenseBrick& other) const;
  /// Returns the voxels of a slice whose weight is at least `least` ≥ 1.
  [[nodiscard]] std::uint64_t weight_at_least(std::size_t slice, std::uint16_t least) const;
  /// Recomputes both masks from v and w.
  void update_masks();
};

inline std::uint64_t FreeBrick::weight_at_least(std::size_t slice, std::uint16_t least) const {
  std::uint64_t greater{0};
  std::uint64_t equal{~std::uint64_t{0}};
  for (std::size_t bit = 3; bit-- > 0;) {
    const std::uint64_t plane = weight_bits[bit].words[slice];
    const bool set = ((least >> bit) & 1U) != 0;
    greater |= set ? 0 : equal & plane;
    equal &= set ? plane : ~plane;
  }
  return least > 7 ? 0 : greater | equal;
}

inline std::uint64_t DenseBrick::weight_at_least(std::size_t slice, std::uint16_t least) const {
  const std::uint64_t observed = ~unknown.words[slice];
  if (least == 1) return observed;
  const std::uint16_t* weights = &w[slice * 64];
  const auto least_before = static_cast<std::uint16_t>(least - 1);
  unsigned rarely{0};  // whether any was observed less often; vector code
  for (std::size_t i = 0; i < 64; ++i) {
    const auto before = static_cast<std::uint16_t>(weights[i] - 1);  // the largest value where unknown
    rarely |= before < least_before ? 1U : 0U;
  }
  if (rarely == 0) return observed;
  std::uint64_t enough{0};
  for (std::size_t i = 0; i < 64; ++i) enough |= std::uint64_t{weights[i] >= least} << i;
  return enough;
}

/// Shared, copy-on-write handle of one brick, 8 bytes. Unknown and constant-free bricks are tagged values; the others
/// point to a reference-counted block. Copies share it; the non-const accessors return an unshared brick to write.
/// Different threads may use different handles.
class BrickRef {
 public:
  BrickRef() = default;  ///< unknown
  [[nodiscard]] static BrickRef constant_free(std::uint16_t w);
  [[nodiscard]] static BrickRef make(const FreeBrick& brick);
  [[nodiscard]] static BrickRef make_dense();  ///< all voxels unknown, ready to be filled
  BrickRef(const BrickRef& other) noexcept;
  BrickRef(BrickRef&& other) noexcept : bits_{std::exchange(other.bits_, 0)} {}
  BrickRef& operator=(BrickRef other) noexcept {
    std::swap(bits_, other.bits_);
    return *this;
  }
  ~BrickRef();

  [[nodiscard]] BrickKind kind() const;
  [[nodiscard]] bool is_unknown() const { return bits_ == 0; }
  /// Requires a constant_free brick.
  [[nodiscard]] std::uint16_t constant_weight() const { return static_cast<std::uint16_t>(bits_); }
  /// Return nullptr for a brick of another kind.
  [[nodiscard]] const FreeBrick* free() const;
  [[nodiscard]] const DenseBrick* dense() const;
  /// Return the brick for writing, unsharing it first. Require a brick of that kind.
  [[nodiscard]] FreeBrick& writable_free();
  [[nodiscard]] DenseBrick& writable_dense();

  [[nodiscard]] Voxel voxel(int i) const;
  [[nodiscard]] Mask512 unknown_mask() const;
  [[nodiscard]] Mask512 occupied_mask() const;
  /// Returns word z of unknown_mask() | occupied_mask(): the voxels that stop rays of view evaluation.
  [[nodiscard]] std::uint64_t nonempty_word(int z) const;

  /// Turns free into constant-free or unknown, and dense into a simpler kind, where the content allows. Each content
  /// has exactly one representation. Drops the colours of a brick without a surface.
  void canonicalize(std::uint16_t free_weight_limit);
  /// Turns *this into the unshared dense form of this brick.
  DenseBrick& densify();
  /// Turns *this, unknown or constant-free, into the free form.
  FreeBrick& expand_to_free();

  /// Tells whether both handles are copies of one, so that their content is known to be equal.
  [[nodiscard]] bool shares(const BrickRef& other) const { return bits_ == other.bits_; }
  /// Returns the bytes on the heap.
  [[nodiscard]] std::size_t heap_bytes() const;
  /// Tells whether both handles hold equal content.
  [[nodiscard]] bool operator==(const BrickRef& other) const;

 private:
  struct Block;
  struct FreeBlock;
  struct DenseBlock;
  static constexpr std::uintptr_t kMaxTag{7};
  explicit BrickRef(Block* block);
  [[nodiscard]] bool is_block() const { return bits_ > kMaxTag; }
  [[nodiscard]] Block* block() const;
  void release() noexcept;
  std::uintptr_t bits_{0};
};

struct BrickRef::Block {
  explicit Block(BrickKind block_kind) : kind{block_kind} {}
  std::atomic<std::uint32_t> references{1};
  BrickKind kind;
};
struct BrickRef::FreeBlock : Block {
  explicit FreeBlock(const FreeBrick& b) : Block{BrickKind::free}, brick{b} {}
  FreeBrick brick;
};
struct BrickRef::DenseBlock : Block {
  DenseBlock() : Block{BrickKind::dense} {}
  explicit DenseBlock(const DenseBrick& b) : Block{BrickKind::dense}, brick{b} {}
  DenseBrick brick;
};

inline BrickRef::BrickRef(Block* block) : bits_{reinterpret_cast<std::uintptr_t>(block)} {}
inline BrickRef::Block* BrickRef::block() const { return reinterpret_cast<Block*>(bits_); }

inline BrickRef::BrickRef(const BrickRef& other) noexcept : bits_{other.bits_} {
  if (is_block()) block()->references.fetch_add(1, std::memory_order_relaxed);
}
inline BrickRef::~BrickRef() {
  if (is_block()) release();
}
inline BrickKind BrickRef::kind() const {
  if (is_block()) return block()->kind;
  return bits_ == 0 ? BrickKind::unknown : BrickKind::constant_free;
}

inline const FreeBrick* BrickRef::free() const {
  return is_block() && block()->kind == BrickKind::free ? &static_cast<FreeBlock*>(block())->brick : nullptr;
}
inline const DenseBrick* BrickRef::dense() const {
  return is_block() && block()->kind == BrickKind::dense ? &static_cast<DenseBlock*>(block())->brick : nullptr;
}

/// 8³ bricks and summaries per brick, which let rays and fusion skip it.
struct Sector {
  std::array<BrickRef, kSectorBricks> bricks;
  Mask512 has_unknown{Mask512::all_set()};  ///< the brick contains an unknown voxel
  Mask512 has_occupied;                     ///< the brick contains an occupied voxel
  Mask512 saturated;  ///< constant free at the weight limit: observing free space again changes nothing

  /// Updates the summaries of brick i after a write.
  void update_summary(int i, std::uint16_t free_weight_limit);
  [[nodiscard]] bool all_unknown() const;
};

class StoredSector;

/// Shared, copy-on-write handle of a sector. Like BrickRef, but never null after make().
class SectorRef {
 public:
  SectorRef() = default;
  [[nodiscard]] static SectorRef make() { return SectorRef{new Block}; }
  SectorRef(const SectorRef& other) noexcept : block_{other.block_} {
    if (block_ != nullptr) block_->references.fetch_add(1, std::memory_order_relaxed);
  }
  SectorRef(SectorRef&& other) noexcept : block_{std::exchange(other.block_, nullptr)} {}
  SectorRef& operator=(SectorRef other) noexcept {
    std::swap(block_, other.block_);
    return *this;
  }
  ~SectorRef() {
    if (block_ != nullptr && block_->references.fetch_sub(1, std::memory_order_acq_rel) == 1) delete block_;
  }

  [[nodiscard]] explicit operator bool() const { return block_ != nullptr; }
  [[nodiscard]] const Sector& operator*() const { return block_->sector; }
  [[nodiscard]] const Sector* get() const { return block_ != nullptr ? &block_->sector : nullptr; }
  /// Returns the sector for writing, unsharing it first. The acquire pairs with a reader's last decrement, so that all
  /// its reads happen before our writes.
  [[nodiscard]] Sector& writable() {
    if (block_->references.load(std::memory_order_acquire) != 1) *this = SectorRef{new Block{block_->sector}};
    if (block_->stored) block_->stored.reset();
    return block_->sector;
  }

  /// Returns the copy of this very content in a store; null where there is none, or the sector was written since.
  [[nodiscard]] const std::shared_ptr<const StoredSector>& stored() const { return block_->stored; }
  /// Remembers such a copy. Requires an unshared handle.
  void set_stored(std::shared_ptr<const StoredSector> stored) {
    SACCADE_EXPECTS(block_->references.load(std::memory_order_acquire) == 1);
    block_->stored = std::move(stored);
  }

 private:
  struct Block {
    Block() = default;
    explicit Block(const Sector& s) : sector{s} {}
    std::atomic<std::uint32_t> references{1};
    Sector sector;
    std::shared_ptr<const StoredSector> stored;
  };
  explicit SectorRef(Block* block) : block_{block} {}
  Block* block_{nullptr};
};

}  // namespace saccade
