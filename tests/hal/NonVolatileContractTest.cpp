#include "host/system/memory_store.hpp"
#include "tests/doubles/fake_non_volatile.hpp"
#include "tests/hal/non_volatile_contract.hpp"

using namespace strainfinger;

namespace {

template <typename Store>
class Bench {
 public:
  Store& store() { return store_; }

 private:
  Store store_;
};

}  // namespace

NON_VOLATILE_CONTRACT(Memory, Bench<system::MemoryStore>)
NON_VOLATILE_CONTRACT(Fake, Bench<doubles::FakeNonVolatile>)
