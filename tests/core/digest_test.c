/* Digests, by the examples of their standards. */
#include "core/crc.h"
#include "core/digest.h"
#include "suite.h"

#include <string.h>

/* The examples of FIPS 180-4 and of NIST's page of example values. */
START_TEST(examples_of_the_standard) {
    char text[SKG_DIGEST_TEXT];
    static const char *const words[] = {"", "abc",
                                        "abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"};
    static const char *const digests[] = {"e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855",
                                          "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad",
                                          "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1"};
    for (size_t i = 0; i < 3; i++) {
        const skg_digest digest = skg_digest_of(words[i], strlen(words[i]));
        skg_digest_text(&digest, text);
        ck_assert_str_eq(text, digests[i]);
    }
}
END_TEST

START_TEST(a_million_letters_in_pieces) {
    char text[SKG_DIGEST_TEXT], letters[997];
    skg_digester digester;
    memset(letters, 'a', sizeof letters);
    skg_digest_start(&digester);
    size_t left = 1000000, piece = 1;
    while (left > 0) {
        const size_t bytes = piece < left ? piece : left;
        skg_digest_add(&digester, letters, bytes);
        left -= bytes;
        piece = piece % 997 + 1; /* every position in a block */
    }
    const skg_digest digest = skg_digest_end(&digester);
    skg_digest_text(&digest, text);
    ck_assert_str_eq(text, "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}
END_TEST

START_TEST(texts_do_not_run_together) {
    skg_digester a, b;
    skg_digest_start(&a);
    skg_digest_start(&b);
    skg_digest_add_text(&a, "ab");
    skg_digest_add_text(&a, "c");
    skg_digest_add_text(&b, "a");
    skg_digest_add_text(&b, "bc");
    const skg_digest of_a = skg_digest_end(&a), of_b = skg_digest_end(&b);
    ck_assert_int_eq(skg_digest_same(&of_a, &of_b), 0);
    ck_assert_int_eq(skg_digest_same(&of_a, &of_a), 1);
}
END_TEST

/* The examples of RFC 3720, appendix B.4, and every length and alignment by both ways. */
START_TEST(checksums_of_the_standard) {
    unsigned char bytes[96] = {0};
    ck_assert_uint_eq(skg_crc32c("123456789", 9), 0xE3069283u);
    ck_assert_uint_eq(skg_crc32c(bytes, 32), 0x8A9136AAu);
    memset(bytes, 255, 32);
    ck_assert_uint_eq(skg_crc32c(bytes, 32), 0x62A8AB43u);
    for (int i = 0; i < 96; i++) bytes[i] = (unsigned char)i;
    ck_assert_uint_eq(skg_crc32c(bytes, 32), 0x46DD794Eu);
    for (size_t from = 0; from < 8; from++)
        for (size_t count = 0; count + from <= 96; count++)
            ck_assert_uint_eq(skg_crc32c(bytes + from, count), skg_crc32c_by_tables(bytes + from, count));
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, checksums_of_the_standard);
    tcase_add_test(tests, examples_of_the_standard);
    tcase_add_test(tests, a_million_letters_in_pieces);
    tcase_add_test(tests, texts_do_not_run_together);
}

SKG_SUITE_MAIN("digest", add_tests)
