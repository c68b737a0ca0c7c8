/* SPDX-License-Identifier: MIT */
/* replay FILE...: a fuzz target without libFuzzer, on inputs that were kept. */
#include "fuzz.h"

static void replay(const char *name)
{
    static uint8_t data[1 << 16];
    FILE *file = fopen(name, "rb");
    FUZZ_REQUIRE(file, "%s cannot be read", name);
    const size_t size = fread(data, 1, sizeof data, file);
    fclose(file);
    uint8_t *copy = malloc(size ? size : 1); /* of that size, for sanitizers */
    memcpy(copy, data, size);
    LLVMFuzzerTestOneInput(copy, size);
    free(copy);
}

int main(int argc, char **argv)
{
    for (int k = 1; k < argc; ++k)
        replay(argv[k]);
    printf("%d inputs\n", argc - 1);
    return argc < 2;
}
