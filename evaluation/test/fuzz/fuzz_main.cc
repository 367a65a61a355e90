// SPDX-License-Identifier: BSD-3-Clause
// touchdown_fuzz --target=NAME [libFuzzer's options] [corpus ...]
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "evaluation/test/fuzz/fuzz_target.h"

namespace {

namespace fuzz = touchdown::evaluation::fuzz;

const fuzz::Target* chosen = nullptr;

const fuzz::Target* Find(const char* name) {
  static const std::vector<fuzz::Target> targets = [] {
    std::vector<fuzz::Target> all = fuzz::ReaderTargets();
    for (const fuzz::Target& target : fuzz::FlyingTargets()) all.push_back(target);
    return all;
  }();
  for (const fuzz::Target& target : targets) {
    if (std::strcmp(target.name, name) == 0) return &target;
  }
  std::fprintf(stderr, "--target=NAME, where NAME is one of:\n");
  for (const fuzz::Target& target : targets) std::printf("%s\n", target.name);
  std::exit(*name == '\0' ? 0 : 2);  // without a name this is the list
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  constexpr char kOption[] = "--target=";
  const char* name = "";
  for (int i = 1; i < *argc; ++i) {
    if (std::strncmp((*argv)[i], kOption, std::strlen(kOption)) == 0) {
      name = (*argv)[i] + std::strlen(kOption);
    }
  }
  chosen = Find(name);
  chosen->run({});  // what it makes once takes longer than an input may
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  chosen->run({reinterpret_cast<const char*>(data), size});
  return 0;
}
