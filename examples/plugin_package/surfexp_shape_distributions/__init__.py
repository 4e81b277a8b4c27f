"""Shape distributions (Osada, Funkhouser, Chazelle and Dobkin 2002) as a signature for surfexp."""
