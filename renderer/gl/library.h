#pragma once
#include <dlfcn.h>

#include <initializer_list>

namespace lumi {

/// A shared library opened at run time; false if no name could be opened. It stays loaded to the end of the program:
/// OpenGL drivers leave thread-local destructors behind, which crash once their code is gone.
class SharedLibrary {
public:
    explicit SharedLibrary(std::initializer_list<const char*> names) {
        for (const char* name : names)
            if (!handle_) handle_ = dlopen(name, RTLD_NOW | RTLD_LOCAL);
    }
    SharedLibrary(const SharedLibrary&) = delete;
    SharedLibrary& operator=(const SharedLibrary&) = delete;

    explicit operator bool() const { return handle_ != nullptr; }
    void* symbol(const char* name) const { return handle_ ? dlsym(handle_, name) : nullptr; }

    template <class Function>
    bool load(Function& function, const char* name) const {
        function = reinterpret_cast<Function>(symbol(name));
        return function != nullptr;
    }

private:
    void* handle_ = nullptr;
};

}  // namespace lumi
