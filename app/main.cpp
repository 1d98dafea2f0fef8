#include "app/commands/program.hpp"

int main(int argc, char** argv) {
  return lodestar::program(argc, argv);
}
