#pragma once

// The part of mbedTLS for a microcontroller: encryption of one block with AES, from tables in
// flash, of which one is enough (three more would save some 30 % of the time and cost 3 KiB).
#define MBEDTLS_AES_C
#define MBEDTLS_AES_ROM_TABLES
#define MBEDTLS_AES_FEWER_TABLES
