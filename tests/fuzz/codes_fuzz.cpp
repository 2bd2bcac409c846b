// Any codes for a finger with the default tables.

#include <bit>

#include "default_tables.hpp"
#include "tests/fuzz/driven_pipeline.hpp"

using namespace strainfinger;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const TableImage tables = std::bit_cast<TableImage>(kDefaultTableBytes);
  fuzz::Input input({data, size});
  fuzz::DrivenPipeline pipeline(tables, input);
  pipeline.run();
  fuzz::require(!pipeline.isSearching());
  return 0;
}
