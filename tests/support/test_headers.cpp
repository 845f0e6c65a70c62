// Nothing but the headers that tests/CMakeLists.txt compiles in advance.
