#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Prints how many times as long as on the machine of tests/budget.json a fixed piece of work takes here: the budgets of
make test are multiplied by it where it is more than 1, as some machines are twice as slow as others.

The work is a compilation, of which most of make test is made, on every core at once."""
import os
import pathlib
import subprocess
import sys
import tempfile
import time

REFERENCE_S = 3.0
SOURCE = """
#include <algorithm>
#include <functional>
#include <map>
#include <random>
#include <regex>
#include <string>
int main(int argc, char** argv) {
  std::map<std::string, std::function<double(double)>> functions;
  std::mt19937_64 random{static_cast<unsigned long>(argc)};
  for (int i = 0; i < argc; ++i) functions[argv[i]] = [&random](double x) { return std::normal_distribution<>{x}(random); };
  return std::regex_search(argv[0], std::regex{"[a-z]+(/[a-z]+)*"}) ? static_cast<int>(functions.size()) : 1;
}
"""


def compile_once(folder):
    source = pathlib.Path(folder) / "work.cpp"
    source.write_text(SOURCE)
    command = ["g++", "-std=c++20", "-O2", "-c", str(source), "-o"]
    began = time.monotonic()
    running = [subprocess.Popen(command + [f"{folder}/{core}.o"]) for core in range(os.cpu_count() or 1)]
    if any(process.wait() for process in running):
        sys.exit("machine_speed: g++ failed")
    return time.monotonic() - began


def main():
    with tempfile.TemporaryDirectory() as folder:
        print(f"{compile_once(folder) / REFERENCE_S:.2f}")


if __name__ == "__main__":
    main()
