# Compiles FILE at two levels of optimization for fused multiply-adds, which it must not show: both print the same bits.
foreach(level IN ITEMS O1 O3)
  set(program "${DIRECTORY}/same_bits_${level}")
  execute_process(
    COMMAND "${COMPILER}" -std=c++20 "-${level}" ${FLAGS} -ffp-contract=off "-I${INCLUDE_DIR}" -isystem
            "${SYSTEM_INCLUDE_DIR}" "${FILE}" -o "${program}" COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND "${program}" OUTPUT_VARIABLE bits_${level} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
if(NOT bits_O1 STREQUAL bits_O3)
  message(FATAL_ERROR "-O1 and -O3 differ:\n${bits_O1}\n${bits_O3}")
endif()
