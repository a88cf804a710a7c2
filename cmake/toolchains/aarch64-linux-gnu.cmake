# For 64-bit ARM with Debian's cross compiler (g++-aarch64-linux-gnu), run under qemu-user-static. Libraries and headers come
# from FORESIGHT_SYSROOT alone, a folder with unpacked arm64 packages that scripts/build_arm64 makes; programs, protoc among
# them, are this machine's.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)

set(FORESIGHT_SYSROOT "" CACHE PATH "Folder with unpacked arm64 packages")
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES FORESIGHT_SYSROOT)
if(NOT IS_DIRECTORY "${FORESIGHT_SYSROOT}/usr/lib/aarch64-linux-gnu")
  message(FATAL_ERROR "FORESIGHT_SYSROOT (${FORESIGHT_SYSROOT}) holds no arm64 packages; run scripts/build_arm64")
endif()

set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
set(CMAKE_FIND_ROOT_PATH ${FORESIGHT_SYSROOT} /usr/aarch64-linux-gnu)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(ENV{PKG_CONFIG_SYSROOT_DIR} ${FORESIGHT_SYSROOT})
set(ENV{PKG_CONFIG_LIBDIR} ${FORESIGHT_SYSROOT}/usr/lib/aarch64-linux-gnu/pkgconfig:${FORESIGHT_SYSROOT}/usr/share/pkgconfig)

# Libraries that libraries need: where the linker looks for them, and where programs do.
set(folders ${FORESIGHT_SYSROOT}/usr/lib/aarch64-linux-gnu:${FORESIGHT_SYSROOT}/lib/aarch64-linux-gnu)
set(CMAKE_EXE_LINKER_FLAGS_INIT "-Wl,-rpath-link,${folders}")
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64-static -L /usr/aarch64-linux-gnu -E LD_LIBRARY_PATH=${folders})
