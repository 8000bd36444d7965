C     scenario.f: the scene of scenario.c in FORTRAN 77. DOFs, pairs and
C     points count from 1 here.
      PROGRAM SCENAR
      INCLUDE 'plmf.inc'
      INTEGER*8 LCTX
      COMMON /PLMLNK/ LCTX
      INTEGER*8 MODEL, IBASIS
      INTEGER IERR
      LCTX = 0
      CALL PLMCCR(LCTX, IERR)
      CALL MUST(IERR)
      CALL MAKMOD(MODEL)
      CALL SHOMOD(MODEL)
      CALL MAKBAS(MODEL, IBASIS)
      CALL SHORES(IBASIS)
      CALL PLMCDE(LCTX, IERR)
      END

      SUBROUTINE MUST(IERR)
      INTEGER*8 LCTX
      COMMON /PLMLNK/ LCTX
      INTEGER IERR, ICODE
      CHARACTER*400 TEXT
      IF (IERR .GE. 0) RETURN
      TEXT = ' '
      CALL PLMCET(LCTX, TEXT, ICODE)
      WRITE (*, *) TEXT
      STOP 1
      END

      SUBROUTINE SHOW(NAME, N, X)
      CHARACTER*(*) NAME
      INTEGER N, I
      DOUBLE PRECISION X(*)
      WRITE (*, '(A)') NAME
      DO 10 I = 1, N
        WRITE (*, '(1PE24.16E3)') X(I)
   10 CONTINUE
      END

      SUBROUTINE SHOWI(NAME, N, INTS)
      CHARACTER*(*) NAME
      INTEGER N, INTS(*), I
      WRITE (*, '(A)') NAME
      DO 10 I = 1, N
        WRITE (*, '(I12)') INTS(I)
   10 CONTINUE
      END

      SUBROUTINE MAKMOD(MODEL)
      INCLUDE 'plmf.inc'
      INTEGER*8 LCTX
      COMMON /PLMLNK/ LCTX
      INTEGER*8 MODEL
      INTEGER N, NPAIRS, I, K, IERR
      PARAMETER (N = 10, NPAIRS = 2)
      INTEGER IDIAG(N), IROW(2*N-1), ICOL(2*N-1), IPTR(NPAIRS+1)
      INTEGER IDOF(3)
      DOUBLE PRECISION XM(N), XK(2*N-1), FRE(N), FIM(N), PRE(N)
      DOUBLE PRECISION COEFF(3), STIFF(NPAIRS), GAP(NPAIRS)
      DATA IPTR /1, 3, 4/
      DATA IDOF /3, 6, 9/
      DATA COEFF /1.0D0, -1.0D0, 1.0D0/
      DATA GAP /0.0D0, 0.001D0/
      STIFF(1) = PLMAUT
      STIFF(2) = 20000.0D0
      K = 0
      DO 10 I = 1, N
        IDIAG(I) = I
        XM(I) = 1.0D0
        FRE(I) = 0.0D0
        FIM(I) = 0.0D0
        PRE(I) = 0.0D0
        K = K + 1
        IROW(K) = I
        ICOL(K) = I
        XK(K) = 20000.0D0
        IF (I .EQ. N) XK(K) = 10000.0D0
        IF (I .GT. 1) THEN
          K = K + 1
          IROW(K) = I
          ICOL(K) = I - 1
          XK(K) = -10000.0D0
        ENDIF
   10 CONTINUE
      FRE(5) = 10.0D0
      PRE(9) = 5.0D0
      MODEL = 0
      CALL PLMMCR(LCTX, N, MODEL, IERR)
      CALL MUST(IERR)
      CALL PLMMMX(MODEL, PLMMAS, PLMTRI, PLMLOW, N, IDIAG, IDIAG, XM,
     1            IERR)
      CALL MUST(IERR)
      CALL PLMMMX(MODEL, PLMSTF, PLMTRI, PLMLOW, K, IROW, ICOL, XK,
     1            IERR)
      CALL MUST(IERR)
      CALL PLMMRD(MODEL, 0.5D0, 0.0002D0, IERR)
      CALL MUST(IERR)
      CALL PLMMGR(MODEL, NPAIRS, IPTR, IDOF, COEFF, STIFF, GAP, IERR)
      CALL MUST(IERR)
      CALL PLMMPL(MODEL, N, PRE, IERR)
      CALL MUST(IERR)
      CALL PLMMEX(MODEL, 1, N, FRE, FIM, IERR)
      CALL MUST(IERR)
      CALL PLMMBU(MODEL, IERR)
      CALL MUST(IERR)
      END

      SUBROUTINE SHOMOD(MODEL)
      INCLUDE 'plmf.inc'
      INTEGER*8 MODEL
      INTEGER IERR, NUMBER, INTS(1)
      DOUBLE PRECISION X(10)
      CALL PLMMGI(MODEL, 'n_free', NUMBER, IERR)
      CALL MUST(IERR)
      INTS(1) = NUMBER
      CALL SHOWI('n_free', 1, INTS)
      CALL PLMMGA(MODEL, 'contact_stiffness', 10, X, NUMBER, IERR)
      CALL MUST(IERR)
      CALL SHOW('contact_stiffness', NUMBER, X)
      CALL PLMMRE(MODEL, IERR)
      CALL MUST(IERR)
      CALL PLMMGA(MODEL, 'rest_displacement', 10, X, NUMBER, IERR)
      CALL MUST(IERR)
      CALL SHOW('rest_displacement', NUMBER, X)
      CALL PLMMFR(MODEL, PLMOPN, 3, X, IERR)
      CALL MUST(IERR)
      CALL SHOW('open_hz', 3, X)
      CALL PLMMFR(MODEL, PLMSLI, 3, X, IERR)
      CALL MUST(IERR)
      CALL SHOW('sliding_hz', 3, X)
      END

      SUBROUTINE MAKBAS(MODEL, IBASIS)
      INCLUDE 'plmf.inc'
      INTEGER*8 MODEL, IBASIS, ISAMPL
      INTEGER IERR, NUMBER, INTS(64)
      DOUBLE PRECISION X(64)
      ISAMPL = 0
      IBASIS = 0
      CALL PLMSCR(MODEL, ISAMPL, IERR)
      CALL MUST(IERR)
      CALL PLMSSC(ISAMPL, 'system', 'open', IERR)
      CALL MUST(IERR)
      CALL PLMSSI(ISAMPL, 'mode', 1, IERR)
      CALL MUST(IERR)
      CALL PLMSSI(ISAMPL, 'n_samples', 3, IERR)
      CALL MUST(IERR)
      CALL PLMSRU(ISAMPL, IERR)
      CALL MUST(IERR)
      CALL PLMSGD(ISAMPL, 'blf_hz', X, IERR)
      CALL MUST(IERR)
      CALL SHOW('blf_hz', 1, X)
      CALL PLMSGA(ISAMPL, 'sweep_alpha', 64, X, NUMBER, IERR)
      CALL MUST(IERR)
      CALL SHOW('sweep_alpha', NUMBER, X)
      CALL PLMSGN(ISAMPL, 'selected_samples', 64, INTS, NUMBER, IERR)
      CALL MUST(IERR)
      CALL SHOWI('selected_samples', NUMBER, INTS)
      CALL PLMBCR(MODEL, IBASIS, IERR)
      CALL MUST(IERR)
      CALL PLMBSS(IBASIS, ISAMPL, IERR)
      CALL MUST(IERR)
      CALL PLMBSI(IBASIS, 'n_harmonics', 5, IERR)
      CALL MUST(IERR)
      CALL PLMBBU(IBASIS, IERR)
      CALL MUST(IERR)
      CALL PLMBGA(IBASIS, 'singular_values', 64, X, NUMBER, IERR)
      CALL MUST(IERR)
      CALL SHOW('singular_values', NUMBER, X)
      CALL PLMSDE(ISAMPL, IERR)
      CALL MUST(IERR)
      END

      SUBROUTINE SHORES(IBASIS)
      INCLUDE 'plmf.inc'
      INTEGER*8 IBASIS, LHBM, CURVE, PEAK
      INTEGER IERR, NUMBER, MAXPTS, IWATCH, INTS(1)
      PARAMETER (MAXPTS = 2000, IWATCH = 8)
      DOUBLE PRECISION X(MAXPTS)
      LHBM = 0
      CURVE = 0
      PEAK = 0
      CALL PLMHCR(IBASIS, LHBM, IERR)
      CALL MUST(IERR)
      CALL PLMHSI(LHBM, 'n_harmonics', 5, IERR)
      CALL MUST(IERR)
      CALL PLMHSC(LHBM, 'unknowns', 'modal', IERR)
      CALL MUST(IERR)
      CALL PLMHSD(LHBM, 'max_step', 0.05D0, IERR)
      CALL MUST(IERR)
      CALL PLMHSW(LHBM, CURVE, IERR)
      CALL MUST(IERR)
      CALL PLMRGI(CURVE, 'n_points', NUMBER, IERR)
      CALL MUST(IERR)
      INTS(1) = NUMBER
      CALL SHOWI('n_points', 1, INTS)
      CALL PLMRGA(CURVE, 'frequency_hz', MAXPTS, X, NUMBER, IERR)
      CALL MUST(IERR)
      CALL SHOW('frequency_hz', NUMBER, X)
      CALL PLMRAM(CURVE, IWATCH, PLMPPM, 0, MAXPTS, X, NUMBER, IERR)
      CALL MUST(IERR)
      CALL SHOW('amplitude', NUMBER, X)
      CALL PLMHPK(LHBM, CURVE, IWATCH, PLMPPM, 0, X(1), X(2), PEAK,
     1            IERR)
      CALL MUST(IERR)
      CALL SHOW('peak', 2, X)
      CALL SHOPNT(PEAK, IWATCH)
      END

      SUBROUTINE SHOPNT(PEAK, IWATCH)
      INCLUDE 'plmf.inc'
      INTEGER*8 PEAK
      INTEGER IWATCH, IERR, N, NTIMES, NPAIRS
      PARAMETER (N = 10, NTIMES = 8, NPAIRS = 2)
      INTEGER ICLOSD(NPAIRS*NTIMES)
      DOUBLE PRECISION X(11), PEN(NPAIRS*NTIMES), FORCE(NPAIRS*NTIMES)
      CALL PLMRCO(PEAK, 1, IWATCH, 1, X, IERR)
      CALL MUST(IERR)
      CALL SHOW('coefficients', 11, X)
      CALL PLMRFI(PEAK, 1, 0.25D0, N, X, IERR)
      CALL MUST(IERR)
      CALL SHOW('field', N, X)
      CALL PLMRCT(PEAK, 1, NTIMES, PEN, FORCE, ICLOSD, IERR)
      CALL MUST(IERR)
      CALL SHOW('penetration', NPAIRS * NTIMES, PEN)
      CALL SHOW('force', NPAIRS * NTIMES, FORCE)
      CALL SHOWI('closed', NPAIRS * NTIMES, ICLOSD)
      CALL PLMRCS(PEAK, 1, NPAIRS, X, IERR)
      CALL MUST(IERR)
      CALL SHOW('closed_share', NPAIRS, X)
      CALL PLMRFR(PEAK, 1, X, IERR)
      CALL MUST(IERR)
      CALL SHOW('full_residual', 1, X)
      END
