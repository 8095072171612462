#include <wakeline/wakeline.hpp>

int other();

int main() { return other(); }
