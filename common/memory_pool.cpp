#include "common/memory_pool.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <new>

namespace foresight {
namespace {

constexpr std::size_t kSmallest = 16;     // bytes of a block, without its header
constexpr std::size_t kSlab = 1U << 20;   // bytes, at least
constexpr std::size_t kClassesAhead = 4;  // a free block up to twice as large serves as well
thread_local MemoryPool* current_pool = nullptr;

}  // namespace

// Before each block. The block's own bytes hold the place of the next one while it is free.
struct alignas(MemoryPool::kAlignment) MemoryPool::Header {
  MemoryPool* pool = nullptr;  // null: the heap's
  std::size_t size_class = 0;

  [[nodiscard]] void* block() { return this + 1; }
  [[nodiscard]] static Header* of(void* block) { return static_cast<Header*>(block) - 1; }
  [[nodiscard]] Header*& next_free() { return *static_cast<Header**>(block()); }

  static void* from_heap(std::size_t bytes) {
    if (bytes > PTRDIFF_MAX - sizeof(Header)) throw std::bad_alloc();
    return (new (::operator new(sizeof(Header) + bytes)) Header)->block();
  }
  static void give_back(void* block) noexcept {
    Header* const header = of(block);
    if (header->pool != nullptr) {
      header->pool->deallocate(block);
    } else {
      ::operator delete(header);
    }
  }
};

MemoryPool::MemoryPool(std::size_t reserve) {
  if (reserve > 0) add_slab(reserve);
}

MemoryPool::~MemoryPool() {
  assert(living_ == 0);
  for (const Slab& slab : slabs_) ::operator delete(slab.begin);
}

// Of a doubling, the classes have 5/4, 6/4, 7/4 and 8/4 of its lower end.
std::size_t MemoryPool::class_of(std::size_t bytes) {
  if (bytes <= kSmallest) return 0;
  const std::size_t last = bytes - 1;
  const auto doubling = static_cast<std::size_t>(std::bit_width(last)) - 1;  // 2^doubling <= last
  const std::size_t quarter = (last >> (doubling - 2)) & 3U;
  return (doubling - std::bit_width(kSmallest) + 1) * kClassesPerDoubling + quarter + 1;
}

std::size_t MemoryPool::size_of(std::size_t size_class) {
  if (size_class == 0) return kSmallest;
  const std::size_t lower = kSmallest << ((size_class - 1) / kClassesPerDoubling);
  const std::size_t size = lower + lower / kClassesPerDoubling * ((size_class - 1) % kClassesPerDoubling + 1);
  return (size + kAlignment - 1) / kAlignment * kAlignment;
}

void MemoryPool::add_slab(std::size_t bytes) {
  slabs_.reserve(slabs_.size() + 1);
  auto* const begin = static_cast<std::byte*>(::operator new(bytes));
  slabs_.push_back({begin, begin, begin + bytes});
  held_ += bytes;
}

// From the first slab with room, from the current one on. What is left of those that have none stays unused until the
// pool starts over.
MemoryPool::Header* MemoryPool::cut(std::size_t size_class) {
  const std::size_t bytes = sizeof(Header) + size_of(size_class);
  const auto room = [](const Slab& slab) { return static_cast<std::size_t>(slab.end - slab.next); };
  std::size_t at = slab_;
  while (at < slabs_.size() && room(slabs_[at]) < bytes) ++at;
  if (at == slabs_.size()) add_slab(std::max(bytes, kSlab));
  Slab& slab = slabs_[at];
  auto* const header = new (slab.next) Header{this, size_class};
  slab.next += bytes;
  used_ += bytes;
  while (slab_ + 1 < slabs_.size() && room(slabs_[slab_]) < sizeof(Header) + kSmallest) ++slab_;
  return header;
}

void* MemoryPool::allocate(std::size_t bytes) {
  const std::size_t wanted = class_of(bytes);
  if (wanted + kClassesAhead >= kClasses) throw std::bad_alloc();
  Header* header = nullptr;
  for (std::size_t c = wanted; c <= wanted + kClassesAhead && header == nullptr; ++c) {
    header = free_[c];
    if (header != nullptr) free_[c] = header->next_free();
  }
  if (header == nullptr) header = cut(wanted);
  ++living_;
  return header->block();
}

void MemoryPool::deallocate(void* block) noexcept {
  Header* const header = Header::of(block);
  header->next_free() = free_[header->size_class];
  free_[header->size_class] = header;
  --living_;
}

void MemoryPool::start_over() noexcept {
  if (living_ > 0) return;
  free_.fill(nullptr);
  for (Slab& slab : slabs_) slab.next = slab.begin;
  slab_ = 0;
  used_ = 0;
}

PoolScope::PoolScope(MemoryPool& pool) : pool_(pool), outer_(current_pool) { current_pool = &pool; }

PoolScope::~PoolScope() {
  current_pool = outer_;
  if (outer_ != &pool_) pool_.start_over();
}

void* pool_detail::allocate(std::size_t bytes) {
  return current_pool != nullptr ? current_pool->allocate(bytes) : MemoryPool::Header::from_heap(bytes);
}

void pool_detail::deallocate(void* block) noexcept { MemoryPool::Header::give_back(block); }

}  // namespace foresight
