# libFuzzer, by clang: the fuzz target over the shared library.
set(PLM_FUZZ_SECONDS 20 CACHE STRING "Seconds of fuzzing in the test host.fuzz")
find_program(PLM_CLANG NAMES clang clang-14 clang-15 clang-16)
if(PLM_SANITIZE)
    add_skipped_host_test(fuzz "the sanitizer runtimes of clang and gcc do not mix")
elseif(PLM_CLANG)
    add_host_test(fuzz sh ${here}/fuzz.sh ${PLM_CLANG} ${PROJECT_SOURCE_DIR}/include $<TARGET_FILE:plm>
                  ${CMAKE_CURRENT_BINARY_DIR}/fuzz ${PLM_FUZZ_SECONDS})
else()
    add_skipped_host_test(fuzz "no clang")
endif()
