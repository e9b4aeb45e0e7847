// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/brick.hpp"

#include <algorithm>

#include "saccade/core/result.hpp"

namespace saccade {

void FreeBrick::observe(const Mask512& seen, std::uint16_t limit) {
  for (std::size_t z = 0; z < 8; ++z) {
    std::uint64_t& b0 = weight_bits[0].words[z];
    std::uint64_t& b1 = weight_bits[1].words[z];
    std::uint64_t& b2 = weight_bits[2].words[z];
    const std::uint64_t at_limit =
        ((limit & 1U) != 0 ? b0 : ~b0) & ((limit & 2U) != 0 ? b1 : ~b1) & ((limit & 4U) != 0 ? b2 : ~b2);
    std::uint64_t carry = seen.words[z] & ~at_limit;
    b0 ^= carry;
    carry &= ~b0;  // the bit was 1 before
    b1 ^= carry;
    carry &= ~b1;
    b2 ^= carry;
  }
}

FreeBrick FreeBrick::constant(std::uint16_t w) {
  FreeBrick brick;
  for (std::size_t bit = 0; bit < 3; ++bit) {
    if (((w >> bit) & 1U) != 0) brick.weight_bits[bit] = Mask512::all_set();
  }
  return brick;
}

DenseBrick::DenseBrick(const DenseBrick& other)
    : v{other.v},
      w{other.w},
      occupied{other.occupied},
      unknown{other.unknown},
      colors{other.colors ? std::make_unique<BrickColors>(*other.colors) : nullptr} {}

bool DenseBrick::operator==(const DenseBrick& other) const {
  if (v != other.v || w != other.w || (colors == nullptr) != (other.colors == nullptr)) return false;
  return colors == nullptr || *colors == *other.colors;
}

void DenseBrick::update_masks() {
  for (std::size_t z = 0; z < 8; ++z) {
    std::uint64_t unknown_word{0};
    std::uint64_t occupied_word{0};
    for (std::size_t i = 0; i < 64; ++i) {
      const bool is_unknown = w[z * 64 + i] == 0;
      const bool not_positive = v[z * 64 + i] <= 0;
      unknown_word |= std::uint64_t{is_unknown} << i;
      occupied_word |= std::uint64_t{!is_unknown && not_positive} << i;
    }
    unknown.words[z] = unknown_word;
    occupied.words[z] = occupied_word;
  }
}

namespace {

/// Tells whether no surface is near: every voxel is unknown or has v = 1 with a weight up to the limit.
bool is_free(const DenseBrick& brick, std::uint16_t weight_limit) {
  if (brick.occupied.any()) return false;
  for (std::size_t slice = 0; slice < kBrickVoxels; slice += 64) {  // whole slices: vector code
    unsigned others{0};
    for (std::size_t i = slice; i < slice + 64; ++i) {
      const unsigned not_one = brick.v[i] != kTsdfOne ? 1 : 0;
      const unsigned heavy = brick.w[i] > weight_limit ? 1 : 0;
      const unsigned known = brick.w[i] != 0 ? 1 : 0;
      others |= known & (not_one | heavy);
    }
    if (others != 0) return false;
  }
  return true;
}

}  // namespace

BrickRef BrickRef::constant_free(std::uint16_t w) {
  SACCADE_EXPECTS(w >= 1 && w <= kMaxTag);
  BrickRef ref;
  ref.bits_ = w;
  return ref;
}
BrickRef BrickRef::make(const FreeBrick& brick) { return BrickRef{new FreeBlock{brick}}; }
BrickRef BrickRef::make_dense() { return BrickRef{new DenseBlock}; }

void BrickRef::release() noexcept {
  if (block()->references.fetch_sub(1, std::memory_order_acq_rel) != 1) return;
  if (block()->kind == BrickKind::free) {
    delete static_cast<FreeBlock*>(block());
  } else {
    delete static_cast<DenseBlock*>(block());
  }
}

FreeBrick& BrickRef::writable_free() {
  SACCADE_EXPECTS(free() != nullptr);
  if (block()->references.load(std::memory_order_acquire) != 1) *this = make(*free());
  return static_cast<FreeBlock*>(block())->brick;
}
DenseBrick& BrickRef::writable_dense() {
  SACCADE_EXPECTS(dense() != nullptr);
  if (block()->references.load(std::memory_order_acquire) != 1) *this = BrickRef{new DenseBlock{*dense()}};
  return static_cast<DenseBlock*>(block())->brick;
}

Voxel BrickRef::voxel(int i) const {
  if (const DenseBrick* d = dense()) return {d->v[static_cast<std::size_t>(i)], d->w[static_cast<std::size_t>(i)]};
  const std::uint16_t w = free() != nullptr ? free()->weight(i) : constant_weight();
  return w == 0 ? Voxel{} : Voxel{kTsdfOne, w};
}

Mask512 BrickRef::unknown_mask() const {
  if (const DenseBrick* d = dense()) return d->unknown;
  if (const FreeBrick* f = free()) return ~f->known();
  return is_unknown() ? Mask512::all_set() : Mask512{};
}

Mask512 BrickRef::occupied_mask() const {
  const DenseBrick* d = dense();
  return d != nullptr ? d->occupied : Mask512{};
}

std::uint64_t BrickRef::nonempty_word(int z) const {
  const auto word = static_cast<std::size_t>(z);
  if (const DenseBrick* d = dense()) return d->unknown.words[word] | d->occupied.words[word];
  if (const FreeBrick* f = free()) {
    return ~(f->weight_bits[0].words[word] | f->weight_bits[1].words[word] | f->weight_bits[2].words[word]);
  }
  return is_unknown() ? ~std::uint64_t{0} : 0;
}

void BrickRef::canonicalize(std::uint16_t free_weight_limit) {
  if (const DenseBrick* d = dense()) {
    if (!is_free(*d, free_weight_limit)) return;
    FreeBrick weights;
    for (int i = 0; i < kBrickVoxels; ++i) weights.set_weight(i, d->w[static_cast<std::size_t>(i)]);
    *this = make(weights);
  }
  if (const FreeBrick* f = free()) {
    const std::uint16_t w = f->weight(0);
    if (*f == FreeBrick::constant(w)) *this = w == 0 ? BrickRef{} : constant_free(w);
  }
}

DenseBrick& BrickRef::densify() {
  if (dense() != nullptr) return writable_dense();
  BrickRef ref = make_dense();
  DenseBrick& d = ref.writable_dense();
  d.unknown = unknown_mask();
  (~d.unknown).for_each([&](std::size_t i) {
    d.v[i] = kTsdfOne;
    d.w[i] = voxel(static_cast<int>(i)).w;
  });
  *this = std::move(ref);
  return writable_dense();
}

FreeBrick& BrickRef::expand_to_free() {
  if (free() == nullptr) {
    SACCADE_EXPECTS(dense() == nullptr);
    *this = make(FreeBrick::constant(constant_weight()));
  }
  return writable_free();
}

std::size_t BrickRef::heap_bytes() const {
  if (const DenseBrick* d = dense()) return sizeof(DenseBlock) + (d->colors ? sizeof(BrickColors) : 0);
  return free() != nullptr ? sizeof(FreeBlock) : 0;
}

bool BrickRef::operator==(const BrickRef& other) const {
  if (bits_ == other.bits_) return true;
  if (kind() != other.kind()) return false;
  if (const DenseBrick* d = dense()) return *d == *other.dense();
  if (const FreeBrick* f = free()) return *f == *other.free();
  return false;
}

void Sector::update_summary(int i, std::uint16_t free_weight_limit) {
  const BrickRef& brick = bricks[static_cast<std::size_t>(i)];
  bool unknown{false};
  bool occupied{false};
  switch (brick.kind()) {
    case BrickKind::unknown: unknown = true; break;
    case BrickKind::constant_free: break;
    case BrickKind::free: unknown = !brick.free()->known().all(); break;
    case BrickKind::dense:
      unknown = brick.dense()->unknown.any();
      occupied = brick.dense()->occupied.any();
      break;
  }
  has_unknown.assign(i, unknown);
  has_occupied.assign(i, occupied);
  saturated.assign(i, brick.kind() == BrickKind::constant_free && brick.constant_weight() == free_weight_limit);
}

bool Sector::all_unknown() const {
  return std::all_of(bricks.begin(), bricks.end(), [](const BrickRef& brick) { return brick.is_unknown(); });
}

}  // namespace saccade
