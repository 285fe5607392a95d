// Tells ThreadSanitizer what oneTBB's library, which is not instrumented, orders. Its headers say through
// call_itt_notify() what a thread hands on (TBB_USE_PROFILING_TOOLS is 2 in preset tsan); that a task begins
// with what its spawner handed on is known inside of the library alone, and is told here. Two tasks of a
// group stay unordered: what they share is still reported.
#if TBB_USE_PROFILING_TOOLS == 2
#include <dlfcn.h>
#include <sanitizer/tsan_interface.h>
#include <tbb/task_group.h>

#include <cstddef>
#include <new>

namespace tbb::detail {
namespace {

/// Runs a spawned task, after all that was done before it was spawned.
class OrderedTask final : public d1::task {
 public:
  explicit OrderedTask(d1::task& spawned) : spawned_(spawned) { __tsan_release(this); }

  d1::task* execute(d1::execution_data& data) override { return takeOver().execute(data); }
  d1::task* cancel(d1::execution_data& data) override { return takeOver().cancel(data); }

 private:
  d1::task& takeOver() {
    __tsan_acquire(this);
    d1::task& spawned = spawned_;
    delete this;
    return spawned;
  }

  d1::task& spawned_;
};

}  // namespace

// In place of libtbb's functions of these names.
namespace r1 {

void call_itt_notify(int type, void* object) {
  if (type == d1::releasing) __tsan_release(object);
  if (type == d1::acquired) __tsan_acquire(object);
}

// Of the pool that the library keeps, ThreadSanitizer knows nothing; of the system's memory all.
void* allocate(d1::small_object_pool*&, std::size_t bytes, const d1::execution_data&) {
  return ::operator new(bytes, std::align_val_t(d1::task_alignment));
}
void* allocate(d1::small_object_pool*&, std::size_t bytes) {
  return ::operator new(bytes, std::align_val_t(d1::task_alignment));
}
void deallocate(d1::small_object_pool&, void* memory, std::size_t, const d1::execution_data&) {
  ::operator delete(memory, std::align_val_t(d1::task_alignment));
}
void deallocate(d1::small_object_pool&, void* memory, std::size_t) {
  ::operator delete(memory, std::align_val_t(d1::task_alignment));
}

void spawn(d1::task& task, d1::task_group_context& group) {
  using Spawn = void(d1::task&, d1::task_group_context&);
  static auto* const spawn = reinterpret_cast<Spawn*>(
      dlsym(RTLD_NEXT, "_ZN3tbb6detail2r15spawnERNS0_2d14taskERNS2_18task_group_contextE"));
  spawn(*new OrderedTask(task), group);
}

void spawn(d1::task& task, d1::task_group_context& group, d1::slot_id slot) {
  using Spawn = void(d1::task&, d1::task_group_context&, d1::slot_id);
  static auto* const spawn = reinterpret_cast<Spawn*>(
      dlsym(RTLD_NEXT, "_ZN3tbb6detail2r15spawnERNS0_2d14taskERNS2_18task_group_contextEt"));
  spawn(*new OrderedTask(task), group, slot);
}

}  // namespace r1
}  // namespace tbb::detail
#endif
