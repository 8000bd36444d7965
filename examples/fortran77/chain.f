C     chain.f: a host of 1985. A chain of masses on springs, clamped at
C     its left end, that runs against stops; the response curve of the
C     last mass, and what happens at its peak. kg, N, m, s.
C
C     Fixed form, COMMON blocks, arrays dimensioned by PARAMETER. Build
C     it with the four files of libplm compiled by the same flags:
C       gfortran -c plm_c.f90 plm_f77.f90 plm_f77_calls.f90
C         plm_f77_keys.f90
C       gfortran -std=legacy -I<folder of plmf.inc> chain.f *.o -lplm
C
      PROGRAM CHAIN
      INCLUDE 'plmf.inc'
      INTEGER*8 MODEL, CURVE, PEAK
      INTEGER*8 LCTX, LHBM
      COMMON /PLMLNK/ LCTX, LHBM
      INTEGER IERR
      DOUBLE PRECISION HZ, AMPL
      CALL ASSEMB
      CALL HANDOV(MODEL, IERR)
      IF (IERR .LT. 0) CALL ABEND('model')
      CALL MODES(MODEL)
      CALL FOLLOW(MODEL, CURVE)
      CALL PEAKAT(CURVE, PEAK, HZ, AMPL)
      CALL REPORT(PEAK, HZ, AMPL)
      CALL PLMCDE(LCTX, IERR)
      END

C     Mass and stiffness, lower triangles by columns, into /MATRIX/
      SUBROUTINE ASSEMB
      INTEGER NMASS, NSTOP, NNZ
      PARAMETER (NMASS = 12, NSTOP = 3, NNZ = 2 * NMASS - 1)
      INTEGER MCOL(NMASS+1), MROW(NMASS), KCOL(NMASS+1), KROW(NNZ)
      DOUBLE PRECISION XM(NMASS), XK(NNZ)
      COMMON /MATRIX/ XM, XK, MCOL, MROW, KCOL, KROW
      INTEGER J, N
      N = 0
      DO 10 J = 1, NMASS
        MCOL(J) = J
        MROW(J) = J
        XM(J) = 2.0D0
        KCOL(J) = N + 1
        N = N + 1
        KROW(N) = J
        XK(N) = 80000.0D0
        IF (J .EQ. NMASS) THEN
          XK(N) = 40000.0D0
        ELSE
          N = N + 1
          KROW(N) = J + 1
          XK(N) = -40000.0D0
        ENDIF
   10 CONTINUE
      MCOL(NMASS+1) = NMASS + 1
      KCOL(NMASS+1) = N + 1
      END

C     Hands the chain over: matrices, damping, stops, force on the end
      SUBROUTINE HANDOV(MODEL, IERR)
      INCLUDE 'plmf.inc'
      INTEGER*8 MODEL
      INTEGER IERR
      INTEGER NMASS, NSTOP, NNZ
      PARAMETER (NMASS = 12, NSTOP = 3, NNZ = 2 * NMASS - 1)
      INTEGER MCOL(NMASS+1), MROW(NMASS), KCOL(NMASS+1), KROW(NNZ)
      DOUBLE PRECISION XM(NMASS), XK(NNZ)
      COMMON /MATRIX/ XM, XK, MCOL, MROW, KCOL, KROW
      INTEGER*8 LCTX, LHBM
      COMMON /PLMLNK/ LCTX, LHBM
      INTEGER ISTOP(NSTOP), IROW(NSTOP+1), I
      DOUBLE PRECISION UNIT(NSTOP), STIFF(NSTOP), GAP(NSTOP)
      DOUBLE PRECISION FRE(NMASS), FIM(NMASS)
      DATA ISTOP /5, 9, 12/
      DATA IROW /1, 2, 3, 4/
      DATA UNIT /3 * 1.0D0/
      DATA STIFF /20000.0D0, 30000.0D0, 40000.0D0/
      DATA GAP /0.0D0, 0.0009765625D0, 0.001953125D0/
      LCTX = 0
      MODEL = 0
      CALL PLMCCR(LCTX, IERR)
      IF (IERR .LT. 0) RETURN
      CALL PLMMCR(LCTX, NMASS, MODEL, IERR)
      IF (IERR .LT. 0) RETURN
      CALL PLMMMX(MODEL, PLMMAS, PLMCSC, PLMLOW, NMASS, MCOL, MROW, XM,
     1            IERR)
      IF (IERR .LT. 0) RETURN
      CALL PLMMMX(MODEL, PLMSTF, PLMCSC, PLMLOW, NNZ, KCOL, KROW, XK,
     1            IERR)
      IF (IERR .LT. 0) RETURN
      CALL PLMMRD(MODEL, 0.5D0, 0.0001220703125D0, IERR)
      IF (IERR .LT. 0) RETURN
      CALL PLMMGR(MODEL, NSTOP, IROW, ISTOP, UNIT, STIFF, GAP, IERR)
      IF (IERR .LT. 0) RETURN
      DO 10 I = 1, NMASS
        FRE(I) = 0.0D0
        FIM(I) = 0.0D0
   10 CONTINUE
      FRE(NMASS) = 1.0D0
      CALL PLMMEX(MODEL, 1, NMASS, FRE, FIM, IERR)
      IF (IERR .LT. 0) RETURN
      CALL PLMMBU(MODEL, IERR)
      END

C     The two lowest frequencies, all stops away and all closed
      SUBROUTINE MODES(MODEL)
      INCLUDE 'plmf.inc'
      INTEGER*8 MODEL
      INTEGER IERR, I
      DOUBLE PRECISION OPEN(2), SLID(2)
      CALL PLMMFR(MODEL, PLMOPN, 2, OPEN, IERR)
      IF (IERR .LT. 0) CALL ABEND('open modes')
      CALL PLMMFR(MODEL, PLMSLI, 2, SLID, IERR)
      IF (IERR .LT. 0) CALL ABEND('sliding modes')
      DO 10 I = 1, 2
        WRITE (*, 100) 'open_hz', OPEN(I)
        WRITE (*, 100) 'sliding_hz', SLID(I)
   10 CONTINUE
  100 FORMAT (A, T20, 1PE24.16E3)
      END

C     Samples, basis, response curve; progress is counted by WATCH.
C     Step by step, and with options, because this is compared with a C
C     program digit by digit, and each call is to be seen once: seven
C     harmonics in place of exact motions, a range that has one peak.
C     PLMMRP does all of it in one call, with no option, as the first
C     program of docs/getting-started.md shows.
      SUBROUTINE FOLLOW(MODEL, CURVE)
      INCLUDE 'plmf.inc'
      INTEGER*8 MODEL, CURVE, ISAMPL, IBASIS
      INTEGER*8 LCTX, LHBM
      COMMON /PLMLNK/ LCTX, LHBM
      INTEGER NCALLS
      COMMON /WATCHD/ NCALLS
      INTEGER IERR, N
      EXTERNAL WATCH
      NCALLS = 0
      ISAMPL = 0
      IBASIS = 0
      LHBM = 0
      CURVE = 0
      CALL PLMCSP(LCTX, WATCH, IERR)
      CALL PLMSCR(MODEL, ISAMPL, IERR)
      CALL PLMSSI(ISAMPL, 'mode', 1, IERR)
      IF (IERR .LT. 0) CALL ABEND('mode')
      CALL PLMSRU(ISAMPL, IERR)
      IF (IERR .LT. 0) CALL ABEND('sampler')
      CALL PLMBCR(MODEL, IBASIS, IERR)
      CALL PLMBSC(IBASIS, 'kind', 'plm', IERR)
      CALL PLMBSS(IBASIS, ISAMPL, IERR)
      CALL PLMBBU(IBASIS, IERR)
      IF (IERR .LT. 0) CALL ABEND('basis')
      CALL PLMHCR(IBASIS, LHBM, IERR)
      CALL PLMHSI(LHBM, 'n_harmonics', 7, IERR)
      CALL PLMHSD(LHBM, 'frequency_min_hz', 2.0D0, IERR)
      CALL PLMHSD(LHBM, 'frequency_max_hz', 5.0D0, IERR)
      IF (IERR .LT. 0) CALL ABEND('options')
      CALL PLMHSW(LHBM, CURVE, IERR)
      IF (IERR .LT. 0) CALL ABEND('sweep')
      CALL PLMBGI(IBASIS, 'size', N, IERR)
      WRITE (*, 110) 'basis_size', N
      CALL PLMRGI(CURVE, 'n_points', N, IERR)
      WRITE (*, 110) 'n_points', N
      IF (NCALLS .EQ. 0) CALL ABEND('no progress was reported')
      CALL PLMCNP(LCTX, IERR)
  110 FORMAT (A, T20, I8)
      END

      SUBROUTINE WATCH(STAGE, FRACTN, ICANCL)
      CHARACTER*(*) STAGE
      DOUBLE PRECISION FRACTN
      INTEGER ICANCL, NCALLS
      COMMON /WATCHD/ NCALLS
      IF (LEN(STAGE) .GT. 0 .AND. FRACTN .GE. 0.0D0) NCALLS = NCALLS + 1
      ICANCL = 0
      END

C     The peak of the last mass
      SUBROUTINE PEAKAT(CURVE, PEAK, HZ, AMPL)
      INCLUDE 'plmf.inc'
      INTEGER*8 CURVE, PEAK
      DOUBLE PRECISION HZ, AMPL
      INTEGER*8 LCTX, LHBM
      COMMON /PLMLNK/ LCTX, LHBM
      INTEGER NMASS, IERR
      PARAMETER (NMASS = 12)
      PEAK = 0
      CALL PLMHPK(LHBM, CURVE, NMASS, PLMPPM, 0, HZ, AMPL, PEAK, IERR)
      IF (IERR .LT. 0) CALL ABEND('peak')
      END

      SUBROUTINE REPORT(PEAK, HZ, AMPL)
      INCLUDE 'plmf.inc'
      INTEGER*8 PEAK
      DOUBLE PRECISION HZ, AMPL
      INTEGER NMASS, NSTOP, NCOEF, I, IERR
      PARAMETER (NMASS = 12, NSTOP = 3, NCOEF = 15)
      DOUBLE PRECISION COEFF(NCOEF), SHARE(NSTOP), Q(NMASS)
      WRITE (*, 100) 'peak_hz', HZ
      WRITE (*, 100) 'peak_m', AMPL
      CALL PLMRCO(PEAK, 1, NMASS, 1, COEFF, IERR)
      IF (IERR .LT. 0) CALL ABEND('coefficients')
      DO 10 I = 1, NCOEF
        WRITE (*, 100) 'coefficient', COEFF(I)
   10 CONTINUE
      CALL PLMRCS(PEAK, 1, NSTOP, SHARE, IERR)
      IF (IERR .LT. 0) CALL ABEND('closed share')
      DO 20 I = 1, NSTOP
        WRITE (*, 100) 'closed_share', SHARE(I)
   20 CONTINUE
      CALL PLMRFI(PEAK, 1, 0.25D0, NMASS, Q, IERR)
      IF (IERR .LT. 0) CALL ABEND('field')
      DO 30 I = 1, NMASS
        WRITE (*, 100) 'field', Q(I)
   30 CONTINUE
  100 FORMAT (A, T20, 1PE24.16E3)
      END

      SUBROUTINE ABEND(WHERE)
      INCLUDE 'plmf.inc'
      CHARACTER*(*) WHERE
      CHARACTER*400 TEXT
      INTEGER*8 LCTX, LHBM
      COMMON /PLMLNK/ LCTX, LHBM
      INTEGER IERR
      TEXT = ' '
      CALL PLMCET(LCTX, TEXT, IERR)
      WRITE (*, *) 'CHAIN STOPS: ', WHERE, ': ', TEXT
      STOP 1
      END
